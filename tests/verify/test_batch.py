"""A job that can be left alone: one run a directory, stops in order, nothing of others lost, no program run for a scene of somebody else's."""
import ctypes
import fcntl
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

import pytest

from conftest import PROGRAM, ROOT, Result
from test_hostile import block
from test_orderly import refused

ENDLESS = {"load": {"step": 0.000005, "max_steps": 200000}, "output": {"fields": False}}  # minutes, however long the machine stands still
PATIENCE = 300  # seconds: only against waiting for ever


def start(path, *options, ranks=1, text=None, env=None, **keywords):
    """The program in the background, in its own process group, on the scene in path."""
    scene = path / "s.yml"
    if text is not None:
        scene.write_text(text)
    command = [str(PROGRAM), str(scene), "-output_directory", str(path / "out"), *map(str, options)]
    if ranks > 1:
        command = ["mpiexec", "-n", str(ranks)] + command
    return subprocess.Popen(command, **({"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "start_new_session": True, "cwd": path,
                                         "env": {**os.environ, **(env or {})}} | keywords))


def becomes(true, process=None):
    """Whether that comes true in PATIENCE of this process's own time (a clock goes on, or is set, where the machine stands still). Asked once each
    time: what was there need not be there when asked again."""
    for _ in range(100 * PATIENCE):
        if true():
            return True
        if process and process.poll() is not None:
            break
        time.sleep(0.01)
    return bool(true())


def wait_for(there, process):
    begun = time.monotonic()
    if not becomes(there, process):
        seconds, status = time.monotonic() - begun, process.poll()
        others = subprocess.run(["ps", "-eo", "pid,ppid,stat,comm,args"], capture_output=True, text=True).stdout
        process.kill()
        pytest.fail(f"{seconds:.1f} s, status {status}, {process.communicate(timeout=PATIENCE)}\n{others}")


def rows(directory):
    path = directory / "history.csv"
    return path.read_text().count("\n") - 1 if path.exists() else 0


def resumed(path, *options):
    process = start(path, *options, "-restart", "auto")
    output, errors = process.communicate(timeout=PATIENCE)
    return Result([], process.returncode, output, errors, path / "out")


# ---- one run a directory ------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ranks", [1, 2])
def test_the_other_run_is_named(tmp_path, ranks):
    text = block(tmp_path, **ENDLESS)
    first = start(tmp_path, text=text)
    wait_for(lambda: rows(tmp_path / "out") > 0, first)
    second = start(tmp_path, ranks=ranks)
    output, errors = second.communicate(timeout=PATIENCE)
    assert second.returncode == 1 and f"another run, process {first.pid} on {socket.gethostname()}" in errors, (output, errors)
    first.terminate()
    output, errors = first.communicate(timeout=PATIENCE)
    assert first.returncode == 3 and not (tmp_path / "out" / "lock").exists(), (output, errors)


def test_what_a_killed_run_leaves(tmp_path):
    """Its lock is told of and taken, and no word of the run before it stays."""
    text = block(tmp_path, **ENDLESS)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "summary.json").write_text('{\n\t"mortise":\t"0", "status": "converged"}')
    first = start(tmp_path, text=text)
    wait_for(lambda: rows(tmp_path / "out") > 1, first)
    assert not (tmp_path / "out" / "summary.json").exists()
    first.kill()
    first.communicate()
    assert not (tmp_path / "out" / "summary.json").exists() and (tmp_path / "out" / "lock").exists()
    second = resumed(tmp_path, "-max_seconds", 0.2)
    assert second.returncode == 3 and f"process {first.pid} on {socket.gethostname()}, did not come to its end" in second.stdout, second
    assert second.summary["status"] == "stopped" and not (tmp_path / "out" / "lock").exists()


def test_who_has_it_writes_its_name(tmp_path):
    """A run that takes over what a killed one has left has the lock before its name stands there (its name was nobody's, process 0)."""
    text = block(tmp_path)
    (tmp_path / "out").mkdir()
    with open(tmp_path / "out" / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        process = start(tmp_path, text=text)
        waiting = f"FLOCK  ADVISORY  READ {process.pid} "
        wait_for(lambda: any("->" in line and waiting in line for line in open("/proc/locks")), process)
        lock.write(f"process {os.getpid()} on {socket.gethostname()}\n")
        lock.flush()
        fcntl.flock(lock, fcntl.LOCK_SH)
        output, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1 and f"another run, process {os.getpid()} on {socket.gethostname()}, writes there" in errors, (output, errors)


def ranks_of(process):
    """Processes that mpiexec has started."""
    return [int(pid) for pid in subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True, text=True).stdout.split()]


@pytest.fixture
def foster():
    """This process takes in those whose parent ends. Else the kernel wakes them where they are stopped (setpgid(2), orphaned groups)."""
    libc, subreaper = ctypes.CDLL(None, use_errno=True), 36
    assert libc.prctl(subreaper, 1, 0, 0, 0) == 0
    yield
    assert libc.prctl(subreaper, 0, 0, 0, 0) == 0


def test_what_is_left_of_a_run(tmp_path, foster):
    """A process that has not noticed that the others are gone keeps the next run away until it has."""
    text = block(tmp_path, **ENDLESS)
    first = start(tmp_path, text=text, ranks=2, start_new_session=False)
    wait_for(lambda: rows(tmp_path / "out") > 1, first)
    leader = int((tmp_path / "out" / "lock").read_text().split()[1])
    last, = [pid for pid in ranks_of(first) if pid != leader]
    os.kill(last, signal.SIGSTOP)
    for pid in first.pid, leader:
        os.kill(pid, signal.SIGKILL)
    first.communicate()
    done = rows(tmp_path / "out")
    refused_run = resumed(tmp_path)
    os.kill(last, signal.SIGKILL)
    os.waitpid(last, 0)
    assert refused_run.returncode == 1 and f"what is left of a run, process {leader}" in refused_run.stderr and rows(tmp_path / "out") == done, refused_run
    again = resumed(tmp_path, "-max_seconds", 0.2)
    assert again.returncode == 3 and again.summary["load_steps"] >= done - 1, again


def test_starts_at_the_same_time(tmp_path):
    """None of them takes away what another has just made; without mpiexec there is nothing to take away."""
    (tmp_path / "tmp").mkdir()
    env = {**os.environ, "TMPDIR": str(tmp_path / "tmp")}
    for _ in range(5):
        processes = [subprocess.Popen([PROGRAM, "--version"], env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(4)]
        for process in processes:
            assert process.communicate(timeout=PATIENCE) == ("mortise 0.1.0\n", "") and process.returncode == 0
            assert not os.listdir(tmp_path / "tmp")


def test_nothing_is_written_without_the_lock(tmp_path):
    text = block(tmp_path, **ENDLESS)
    first = start(tmp_path, text=text)
    wait_for(lambda: rows(tmp_path / "out") > 1, first)
    (tmp_path / "out" / "lock").unlink()
    output, errors = first.communicate(timeout=PATIENCE)
    assert first.returncode == 2 and len(errors.splitlines()) == 1 and "Nothing more is written" in errors, (output, errors)


# ---- files of others ----------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["summary.json", "history.csv", "adapt.csv", "fields.xdmf", "passes.xdmf", "fields_0000.h5", "checkpoint.h5", "lock"])
def test_files_of_others_stay(run, tmp_path, name):
    text, file = block(tmp_path), tmp_path / "out1" / name
    file.parent.mkdir()
    file.write_text("mine\n")
    (file.parent / "fields_1.h5").write_text("mine\n")  # no name of ours
    for options in (), ("-check",), ("-restart", "auto"):
        result = run("s.yml", *options, "-output_directory", file.parent, text=text)
        assert result.returncode == 1 and len(result.stderr.splitlines()) == 1, result
        assert file.read_text() == "mine\n" and sorted(os.listdir(file.parent)) == sorted(["fields_1.h5", name]), result
        if options != ("-restart", "auto") or name != "checkpoint.h5":
            assert f"{name} in it is no file of a run" in result.stderr and "output.overwrite" in result.stderr, result
    result = run("s.yml", "-output_directory", file.parent, "-output_overwrite", "true", text=text)
    assert result.returncode == 0 and file.exists() == (name not in ("passes.xdmf", "lock")) and (not file.exists() or file.read_bytes() != b"mine\n"), result
    assert (file.parent / "fields_1.h5").read_text() == "mine\n"
    assert run("s.yml", "-output_directory", file.parent, text=text).returncode == 0  # ours now


@pytest.mark.parametrize("name", ["history.csv", "adapt.csv", "summary.json.tmp", "checkpoint.h5.tmp"])
def test_links_and_pipes_are_not_written(run, tmp_path, name):
    """What they lead to stays, and nobody is waited for."""
    (tmp_path / "out1").mkdir()
    (tmp_path / "mine").write_text("mine\n")
    for place in (lambda path: path.symlink_to(tmp_path / "mine")), os.mkfifo:
        (tmp_path / "out1" / name).unlink(missing_ok=True)
        place(tmp_path / "out1" / name)
        result = run("s.yml", "-output_directory", tmp_path / "out1", "-output_overwrite", "true", text=block(tmp_path), timeout=PATIENCE)
        assert result.returncode == 0 and (tmp_path / "mine").read_text() == "mine\n", result


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("setpriv"), reason="may not become somebody else")
@pytest.mark.parametrize("options", [(), ("-restart", "auto"), ("-check",)])
def test_results_that_may_not_be_written(options):
    """Those of before stay as they are."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        text = block(path)
        (path / "s.yml").write_text(text)
        command = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", PROGRAM, "s.yml", "-output_directory", "out"]
        os.chmod(path, 0o777)
        assert subprocess.run([*command, "-load_max_steps", "1"], cwd=path, capture_output=True).returncode == 2
        for file in (path / "out").iterdir(): file.chmod(0o444)
        before = {file.name: file.read_bytes() for file in (path / "out").iterdir()}
        done = subprocess.run([*command, *options], cwd=path, capture_output=True, text=True)
        assert done.returncode == 1 and "in it may not be written" in done.stderr and done.stderr.count("\n") == 1, done
        assert {file.name: file.read_bytes() for file in (path / "out").iterdir()} == before


@pytest.mark.parametrize("there", [True, False])
def test_a_link_in_place_of_the_lock(run, tmp_path, there):
    """What it leads to is not written."""
    (tmp_path / "out1").mkdir()
    (tmp_path / "out1" / "lock").symlink_to(tmp_path / "mine")
    if there: (tmp_path / "mine").write_text("mine\n")
    result = run("s.yml", "-output_directory", tmp_path / "out1", text=block(tmp_path))
    assert result.returncode == 1 and "lock in it is no file of a run" in result.stderr and (tmp_path / "mine").exists() == there, result
    result = run("s.yml", "-output_directory", tmp_path / "out1", "-output_overwrite", "true", text=block(tmp_path))
    assert result.returncode == 0 and (tmp_path / "mine").exists() == there and (not there or (tmp_path / "mine").read_text() == "mine\n"), result


# ---- stops --------------------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number,held", [(signal.SIGTERM, False), (signal.SIGHUP, False), (signal.SIGXCPU, False), (signal.SIGQUIT, False), (signal.SIGUSR2, False),
                                         (signal.SIGTERM, True)])
def test_signals_stop_in_order(tmp_path, number, held):
    """Those too that who starts the program has held back for itself."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS), preexec_fn=lambda: signal.pthread_sigmask(signal.SIG_BLOCK if held else signal.SIG_UNBLOCK, {number}))
    wait_for(lambda: rows(tmp_path / "out") > 1, process)
    process.send_signal(number)
    output, errors = process.communicate(timeout=PATIENCE)
    result = Result([], process.returncode, output, errors, tmp_path / "out")
    assert result.returncode == 3 and result.summary["reason"].startswith(number.name) and not errors, result
    assert sorted(os.listdir(tmp_path / "out")) == ["adapt.csv", "checkpoint.h5", "history.csv", "summary.json"]
    assert result.summary["load_steps"] == rows(tmp_path / "out")


def test_asked_twice_at_once(tmp_path):
    """As `timeout` asks, the process and then its group: one request. A second one later ends the program at once."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS))
    wait_for(lambda: rows(tmp_path / "out") > 1, process)
    for _ in range(3):
        process.send_signal(signal.SIGTERM)
        time.sleep(0.002)  # so that each is heard, not one for all of them
    output, errors = process.communicate(timeout=PATIENCE)
    result = Result([], process.returncode, output, errors, tmp_path / "out")
    assert result.returncode == 3 and result.summary["reason"].startswith("SIGTERM") and not errors, result
    assert sorted(os.listdir(tmp_path / "out")) == ["adapt.csv", "checkpoint.h5", "history.csv", "summary.json"]


def test_nobody_reads(tmp_path):
    """Standard output into a pipe whose reader goes, as `head` does."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS))
    process.stdout.readline()
    process.stdout.close()
    process.stdout = None
    _, errors = process.communicate(timeout=PATIENCE)
    result = Result([], process.returncode, "", errors, tmp_path / "out")
    assert result.returncode == 3 and result.summary["reason"].startswith("SIGPIPE"), result


def test_children_that_nobody_waits_for(tmp_path):
    """SIGCHLD ignored by who starts the program: how gmsh has ended is told all the same."""
    (tmp_path / "s.geo").write_text((ROOT / "inputs/cube.geo").read_text())
    process = start(tmp_path, "-check", text=(ROOT / "inputs/cube.yml").read_text().replace("cube.geo", "s.geo"), preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN))
    output, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0 and not errors, (output, errors)


def test_nohup(tmp_path):
    process = start(tmp_path, text=block(tmp_path, load={"step": 0.01}), preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_for(lambda: rows(tmp_path / "out") > 1, process)
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=PATIENCE)
    assert process.returncode == 0


def children(name):
    """Processes of that name, by number."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and (entry / "comm").read_text().strip() == name:
                found.append((int(entry.name), (entry / "cmdline").read_text()))
        except OSError:
            pass
    return found


@pytest.mark.parametrize("number,ranks", [(signal.SIGTERM, 1), (signal.SIGTERM, 2), (signal.SIGKILL, 1)])
def test_stopped_while_gmsh_meshes(tmp_path, number, ranks):
    """The end is that of other runs that are stopped, which batch scripts begin again; no gmsh is left, and, but where nothing can be done any more, no
    directory."""
    (tmp_path / "endless.geo").write_text("For i In {1:2000000000}\nx = i;\nEndFor\n")
    (tmp_path / "tmp").mkdir()
    text = block(tmp_path, mesh={"file": "endless.geo"})
    gmsh_itself = {"MORTISE_TEST_MESHES": ""}  # what keeps meshes for the tests would stand between the program and gmsh
    process = start(tmp_path, text=text, ranks=ranks, env={"TMPDIR": str(tmp_path / "tmp"), **gmsh_itself})

    def meshing():
        return [pid for pid, command in children("gmsh") if str(tmp_path) in command]

    wait_for(meshing, process)
    process.send_signal(number)
    process.communicate(timeout=PATIENCE)
    assert becomes(lambda: not meshing())  # a busy machine takes its time to end a process
    if number == signal.SIGTERM:
        assert not list((tmp_path / "tmp").glob("mortise-*"))
    if number == signal.SIGTERM and ranks == 1:  # mpiexec has a status of its own
        assert process.returncode == 3 and not (tmp_path / "out").exists(), process.communicate()


@pytest.mark.parametrize("wait", [0, 0.02, 0.05])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_stopped_while_it_starts(tmp_path, number, wait):
    """No handler of MPI or PETSc answers; one that comes before main is the system's."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS))

    def began():
        masks = dict(line.split(":\t") for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines() if line.startswith("Sig"))
        return os.path.samefile(f"/proc/{process.pid}/exe", PROGRAM) and (int(masks["SigBlk"], 16) | int(masks["SigCgt"], 16)) >> (number - 1) & 1

    wait_for(began, process)
    time.sleep(wait)
    process.send_signal(number)
    output, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 3 and errors == "", (process.returncode, output, errors)


# ---- two checkpoints ----------------------------------------------------------------------------------------------------------------------


def test_the_checkpoint_before(tmp_path):
    """A checkpoint that the disk has lost costs a step more."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS))
    checkpoint, before = tmp_path / "out" / "checkpoint.h5", tmp_path / "out" / "checkpoint_before.h5"
    wait_for(lambda: rows(tmp_path / "out") > 3 and before.exists(), process)
    process.kill()
    process.communicate()
    assert before.exists()
    part = checkpoint.read_bytes()[:1000]
    checkpoint.unlink()  # for a moment both names are of one file
    checkpoint.write_bytes(part)
    done = rows(tmp_path / "out")
    result = resumed(tmp_path, "-max_seconds", 0.3)
    assert result.returncode == 3 and "checkpoint.h5 is not whole, the one before it is taken" in result.stdout, result
    goes_on = int(next(line for line in result.stdout.splitlines() if line.startswith("goes on after")).split()[5].rstrip(","))
    assert done - 2 <= goes_on <= done and result.summary["load_steps"] == rows(tmp_path / "out") and not before.exists(), result


# ---- a .geo that is a program -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("line,words", [
    ("Printf('\"'); SystemCall \"touch here\"; Printf('\"');", "SystemCall calls a program"),  # quotes of either kind
    ('/**//* " */ SystemCall "touch here"; //"', "SystemCall calls a program"),
    ('StringToName["SystemCall"] "touch here";', "StringToName makes a statement"), ('S2N["SystemCall"] "touch here";', "S2N makes a statement"),
    ('Error("x") > "here";', "Error writes a file"), ('Save "here.msh";', "Save writes a file"), ('Print "here.png";', "Print writes a file"),
    ('CreateDir "here";', "CreateDir makes"), ('Include StrCat("mo", "re");', "at run time"), ('Include "more";', "more:1: SystemCall"),
    ('Field[1] = ExternalProcess; Field[1].CommandLine = "touch here";', "ExternalProcess calls"), ("\0\nSystemCall 'touch here';", "zero byte"),
    ('Include "pipe";', "pipe:1: this is no file that could be read here"), ('Include ".";', "this is no file that could be read here"),
    ('Merge "more";', "Merge takes a file that is no .geo"), ('Merge "more.py";', "Merge takes a file that is no .geo"), ('Merge "more.pro";', "is no .geo"),
    ('Include "more.msh";', "more.msh:1: SystemCall"), ('Merge "more.msh";', "does not begin with $MeshFormat"), ('Merge "more.Step";', "is no .geo"),
    ('Merge "options.stl";', "options.stl.opt:1: SystemCall"), ('Include "options.stl";', "options.stl.opt:1: SystemCall"),
    ('Merge "options.geo";', "options.geo.opt.opt:1: SystemCall"), ('Include "C:/more";', "with \\ or : in it"), ('Include "/proc/self/cmdline";', "no file that could be read"),
    ("x = '" + 1023 * "a" + " SystemCall \"touch here\"; //';", "SystemCall calls"), ("Printf('" + 1023 * "a" + ") > \"here\"; //');", "Printf has a string of more than 1023"),
    ('Plugin(Bubbles).OutputFile = "here"; Plugin(Bubbles).Run;', "Plugin may write a file"), ('Solver.Extension0 = ".stp";', "Solver sets a program"),
    ('For i In {1:2} /*\nSystemCall "touch here"; // */\nEndFor', "SystemCall calls"),  # gmsh goes back to the line behind that of For
    ("If(0)\nx = \" EndIf SystemCall 'touch here'; \";\nEndIf", "SystemCall calls"),  # and looks for EndIf in strings
    ('text = "here"; Save text;', "Save writes a file"), ("Save View[0] 'here';", "Save writes a file"),
    ('Print.Format = 1; Mesh.SaveAll = 0; Merge "none.msh";', None), ('Printf("Save x > %g", 1);', None), ("Save = 1; y = Save + 1;", None), ("Save[] = {1, 2};", None),
    ("For Save In {1:2} // SystemCall 'touch here';\nEndFor", None), ("/* of more lines\nSystemCall 'touch here'; */", None), ('Merge "good.msh"; Include "good.geo";', None),
])
def test_a_geo_is_looked_through(run, tmp_path, line, words):
    (tmp_path / "s.geo").write_text(f"Point(1) = {{0, 0, 0}};\n{line}\n")
    for name in ("more", "more.msh", "more.py", "more.Step", "options.stl.opt", "options.geo.opt.opt"):
        (tmp_path / name).write_text('SystemCall "touch here";\n')
    for name in ("options.stl", "options.geo", "options.geo.opt", "good.geo", "good.geo.opt"):
        (tmp_path / name).write_text("x = 1;\n")
    (tmp_path / "good.msh").write_text("$MeshFormat\n")
    os.mkfifo(tmp_path / "pipe")  # nobody writes to it
    result = run("s.yml", "-check", text=block(tmp_path, mesh={"file": "s.geo"}))
    if words:
        refused(result, words, "mesh.trust")
    else:
        assert "mesh.trust" not in result.stderr, result


def test_a_geo_is_looked_through_in_bounded_time(run, tmp_path):
    """Each statement is read to its end, not to that of the file."""
    (tmp_path / "s.geo").write_text(100000 * "Printf(" + "\n")
    assert "mesh.trust" not in run("s.yml", "-check", text=block(tmp_path, mesh={"file": "s.geo"})).stderr


def test_options_beside_a_geo(run, tmp_path):
    (tmp_path / "s.geo").write_text("Point(1) = {0, 0, 0};\n")
    (tmp_path / "s.geo.opt").write_text('SystemCall "touch here";\n')  # gmsh reads it unasked
    refused(run("s.yml", "-check", text=block(tmp_path, mesh={"file": "s.geo"})), "s.geo.opt:1: SystemCall")


def test_a_geo_that_is_trusted(run, tmp_path):
    (tmp_path / "s.geo").write_text(f'SystemCall "touch {tmp_path}/here";\n' + (ROOT / "inputs" / "cube.geo").read_text())
    scene = (ROOT / "inputs" / "cube.yml").read_text().replace("cube.geo", "s.geo")
    assert run("s.yml", "-check", "-mesh_trust", "true", text=scene).returncode == 0 and (tmp_path / "here").exists()


@pytest.mark.parametrize("text,words", [
    ("// DefineConstant[n = 3];", "declares no such constant"), ("/* n */ x = 'a n b';", "declares no such constant"), ("Mesh.n = 3;", "declares no such constant"),
    ("n = 5;\nDefineConstant[n = 1];", "gives it a value before it declares it"), ("DefineConstant[n = 1]; n = n + 1;", None), ("If (!Exists(n)) n = 1; EndIf", None),
    ("If (1) n = 1; EndIf", None), ("x = n;", None), ("n = DefineNumber[1, Name 'n'];", None), ("If (n == 1) x = 1; EndIf", None), ("Include 'more.geo';\nn = 1;", None),
])
def test_constants_of_a_geo(run, tmp_path, text, words):
    """Those that it declares, where a value from outside acts."""
    (tmp_path / "s.geo").write_text(f"Point(1) = {{0, 0, 0}};\n{text}\n")
    result = run("s.yml", "-check", "-mesh_parameter_n", 2, text=block(tmp_path, mesh={"file": "s.geo"}))
    refused(result, words or "mesh.file")
    assert ("mesh.parameter.n" in result.stderr) == bool(words), result


# ---- what is told ---------------------------------------------------------------------------------------------------------------------------


def test_options_of_the_working_directory(tmp_path):
    text = block(tmp_path)
    (tmp_path / ".petscrc").write_text("# of PETSc\n-snes_max_it 7\n")
    for options, told in ((), True), (("-skip_petscrc",), False):
        output, errors = start(tmp_path, "-check", *options, text=text).communicate(timeout=PATIENCE)
        assert ("note: options of .petscrc in the working directory act" in output) == told and not errors, (output, errors)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("options,word", [("order 2", "order"), ("-order 2 3", "3"), ("-order -2", ""), (" -order 2  ", None)])
def test_words_of_petsc_options(tmp_path, options, word, ranks):
    """One without its dash would not act."""
    process = start(tmp_path, "-check", text=block(tmp_path), ranks=ranks, env={"PETSC_OPTIONS": options})
    output, errors = process.communicate(timeout=PATIENCE)
    result = Result([], process.returncode, output, errors, tmp_path / "out")
    if word is None:
        assert result.returncode == 0 and "order 2" in output and not errors, result
    else:
        refused(result, f"PETSC_OPTIONS: '{word}' is neither an option" if word else "PETSC_OPTIONS: order is -2")


@pytest.mark.parametrize("limit,words,ranks", [("-s 128", "the stack may not grow beyond 128 kB (ulimit -s)", 1), ("-s 128", "the stack may not grow beyond 128 kB (ulimit -s)", 2),
                                               ("-n 10", "no more than 10 files may be open at a time (ulimit -n)", 1), ("-n 20", "no more than 20 files", 2)])
def test_small_limits(tmp_path, limit, words, ranks):
    """Where more is allowed it is taken, else one sentence."""
    (tmp_path / "s.yml").write_text(block(tmp_path))
    for kind, good in ("-S", True), ("", False):
        launch = "mpiexec -n 2 " if ranks == 2 else ""
        process = subprocess.run(["sh", "-c", f"{launch}sh -c 'ulimit {kind} {limit} && exec {PROGRAM} s.yml -output_directory out'"], cwd=tmp_path, capture_output=True, text=True)
        if good:
            assert process.returncode == 0 and not process.stderr, process
            shutil.rmtree(tmp_path / "out")
        else:
            refused(Result([], process.returncode, process.stdout, process.stderr, tmp_path / "out"), words)


def test_a_closed_screen(tmp_path):
    """What is said goes nowhere, not into the files and pipes that are opened next."""
    process = start(tmp_path, text=block(tmp_path, **ENDLESS), stdout=None, stderr=None, preexec_fn=lambda: os.closerange(0, 3))
    wait_for(lambda: rows(tmp_path / "out") > 1, process)
    files = [os.readlink(f"/proc/{process.pid}/fd/{k}") for k in range(3)]
    process.terminate()
    assert process.wait(timeout=PATIENCE) == 3 and files == ["/dev/null"] * 3, files


@pytest.mark.parametrize("words", [["s.yml"], ["s.yml", "-check"], ["-list"]])
def test_a_full_screen(tmp_path, words):
    """Told, with an exit status; results are whole."""
    (tmp_path / "s.yml").write_text(block(tmp_path))
    with open("/dev/full", "w") as full:
        done = subprocess.run([PROGRAM, *words], cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE)
    assert done.returncode == 2 and done.stderr == "mortise: standard output could not be written to its end, as on a full disk\n", done
    assert words != ["s.yml"] or json.loads((tmp_path / "out/s/summary.json").read_text())["status"] == "converged"


@pytest.mark.parametrize("option", ["-order", "-model", "-load_step", "-boundary_y1_displacement_y", "-boundary_y0_fix", "-material_m_law", "-material_m_E", "-mesh_file",
                                    "-solve_rtol", "-max_seconds", "-body_body_material", "-adapt_coarsen"])
def test_long_values(run, tmp_path, option):
    result = run("s.yml", "-check", option, "w" * 3000, text=block(tmp_path))
    assert result.returncode == 1 and "w" * 81 not in result.stderr and len(result.stderr.splitlines()) == 1, result


def test_control_characters(run, tmp_path):
    refused(run("s.yml", "-title", "\033[31m", text=block(tmp_path)), "control character in the value of -title")
    refused(run("a\033[31mb.yml", text=block(tmp_path)), "name of the scene has a control character", "a?[31mb.yml")


def test_no_figure_no_number(run, tmp_path):
    """Without load nothing can be estimated: the field is empty."""
    text = block(tmp_path, boundary={"y0": {"fix": "xy"}, "y1": {"displacement": {"y": "t < 0.6 ? 0 : -0.05"}}})
    result = run("s.yml", text=text)
    assert result.returncode == 0 and "nan" not in (result.directory / "history.csv").read_text() + (result.directory / "adapt.csv").read_text(), result
    first, last = (row.split(",") for row in (result.directory / "history.csv").read_text().splitlines()[1:])
    assert first[9] == "" and float(last[9]) > 0 and str(result.history[0]["estimated_error"]) == "nan"


def test_equilibrium_deserves_its_name(run, tmp_path):
    refused(run("s.yml", "-solve_rtol", 0.01, text=block(tmp_path)), "-solve_rtol is '0.01'", "1e-3 at most")
    assert run("s.yml", "-solve_rtol", 1e-3, text=block(tmp_path)).returncode == 0


def test_checkpoints_name_their_file(run, tmp_path):
    name = "checkpoint.h5.tmp"
    (tmp_path / "out1" / name).mkdir(parents=True)
    result = run("s.yml", "-output_overwrite", "true", text=block(tmp_path))
    assert result.returncode == 2 and f"{tmp_path}/out1/{name}: " in result.stderr and len(result.stderr.splitlines()) == 1, result


def msh(nodes, cells, lines):
    """Format 2.2: positions, cells of body `body`, lines of y0 and y1, by numbers of nodes."""
    elements = [f"3 2 101 101 {' '.join(map(str, cell))}" for cell in cells] + [f"1 2 {group} {group} {a} {b}" for group, a, b in lines]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 101 "body"', '1 3 "y0"', '1 4 "y1"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
                     + [f"{i + 1} {x} {y} 0" for i, (x, y) in enumerate(nodes)] + ["$EndNodes", "$Elements", str(len(elements))]
                     + [f"{i + 1} {element}" for i, element in enumerate(elements)] + ["$EndElements", ""])


@pytest.mark.parametrize("turned", [False, True])
def test_a_cell_listed_twice(run, tmp_path, turned):
    text, nodes = block(tmp_path, mesh={"file": "d.msh"}), [(0, 0), (1, 0), (1, 1), (0, 1)]
    (tmp_path / "d.msh").write_text(msh(nodes, [[1, 2, 3, 4], [2, 3, 4, 1] if turned else [1, 2, 3, 4]], [(3, 1, 2), (4, 3, 4)]))
    refused(run("s.yml", "-check", text=text), "mesh cells 1 and 2", "one cell listed twice")


@pytest.mark.parametrize("aside", [0, 1e-3])
def test_a_mesh_that_hangs(run, tmp_path, aside):
    """Two small cells on a large one."""
    text = block(tmp_path, mesh={"file": "d.msh"})
    nodes = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 1 + aside), (0, 2), (0.5, 2), (1, 2)]
    (tmp_path / "d.msh").write_text(msh(nodes, [[1, 2, 3, 4], [4, 5, 7, 6], [5, 3, 8, 7]], [(3, 1, 2), (4, 6, 7), (4, 7, 8)]))
    said = run("s.yml", "-check", text=text).stdout
    assert ("1 nodes lie on sides of cells whose corners they are not, one of body body on a side of body body at (0.5, 1, 0)" in said) == (aside == 0), said


def test_what_hangs_in_space(run, tmp_path):
    """Cells of half the size on a block, a side of each in one plane; with a pair between them there is nothing to tell."""
    from boxmesh import linspace, write
    write(tmp_path / "blocks.msh", [linspace(0, 1, 1)] * 3, [lambda x, y, z: (x, y, z), lambda x, y, z: (x / 2 + 0.1, y / 2, 1 + z)],
          side=lambda name, centre, b: f"{name}_{'lu'[b]}", body=lambda centre, b: "lu"[b])
    for contact, told in ({}, True), ({"p": {"nonmortar": "z0_u", "mortar": "z1_l"}}, False):
        text = block(tmp_path, mesh={"file": "blocks.msh"}, model="3d", body={"l": {"material": "m"}, "u": {"material": "m"}}, contact=contact,
                     boundary={"z0_l": {"fix": "xyz"}, "z1_u": {"displacement": {"x": 0, "y": 0, "z": -0.05}}})
        said = run("s.yml", "-check", text=text).stdout
        assert ("4 nodes lie on sides of cells" in said) == told, said
