"""Copies of a program that has been loaded once (server.c), each a start of it; what it and its libraries read from the environment when they are loaded is that of the first."""
import os
import pathlib
import select
import struct
import subprocess


def build(library):
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, pathlib.Path(__file__).with_name("server.c"), "-ldl"], check=True)


def sanitized(program):
    """It maps terabytes, and its library wants to be the first."""
    return b"__asan_init" in pathlib.Path(program).read_bytes()


class Server:
    """One copy at a time."""

    def __init__(self, program, library, environment):
        pipes = [os.pipe(), os.pipe()]
        ours, theirs = (pipes[0][1], pipes[1][0]), (pipes[0][0], pipes[1][1])

        def place():
            for k in 0, 1:
                os.dup2(theirs[k], 198 + k)

        self.environment = environment
        self.process = subprocess.Popen([program], env=environment | {"LD_PRELOAD": str(library)}, close_fds=False, preexec_fn=place)
        self.requests, self.answers = ours
        for k in theirs:
            os.close(k)

    def read(self, num):
        data = b""
        while len(data) < 8 * num:
            part = os.read(self.answers, 8 * num - len(data))
            if not part: raise OSError("tests/tools/server.c has ended")
            data += part
        return struct.unpack(f"{num}l", data)

    def start(self, arguments, folder, stdout, stderr, memory=0, environment=None):
        """The number of the process; memory: a limit in bytes."""
        words = (folder, stdout, stderr, *arguments)
        variables = [f"{key}={value}" for key, value in (environment or self.environment).items()]
        text = b"".join(os.fsencode(str(word)) + b"\0" for word in (*words, *variables))
        data = struct.pack("4l", len(text), memory, len(words), len(variables)) + text
        while data:
            data = data[os.write(self.requests, data):]
        return self.read(1)[0]

    def ended(self, seconds):
        """Whether the copy has come to its end, after so many seconds at the latest."""
        return bool(select.select([self.answers], [], [], seconds)[0])

    def wait(self):
        """Status of the copy, as of os.wait, and its most memory in kB."""
        return self.read(2)

    def close(self):
        os.close(self.requests)
        os.close(self.answers)
        self.process.wait()
