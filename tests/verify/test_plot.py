"""scripts/plot draws what a run left: the curves of adapt.csv and the outlines of cells, not of their sub-cells."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import runpy
import shutil
import subprocess
import sys

import numpy as np
import pytest

from conftest import PROGRAM, ROOT

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "plot"
loader = importlib.machinery.SourceFileLoader("plot", str(SCRIPT))
plot = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot", loader))
loader.exec_module(plot)


def test_outline_is_of_cells():
    """Two cells side by side, 2 x 2 sub-cells each: 8 edges around each cell, the 4 inside it not drawn."""
    number = np.arange(15).reshape(3, 5)  # points of a 4 x 2 grid of sub-cells
    quads = np.array([(number[j, i], number[j, i + 1], number[j + 1, i + 1], number[j + 1, i]) for j in range(2) for i in range(4)])
    leaf = np.array([i // 2 for j in range(2) for i in range(4)])
    edges, owner = plot.outline(quads, leaf)
    assert len(edges) == 16
    drawn = {tuple(sorted(e)) for e in edges}
    assert (2, 7) in drawn and (7, 12) in drawn  # between the two cells
    assert (1, 6) not in drawn and (5, 6) not in drawn  # inside the first
    assert all(set(edge) <= set(quads[q]) for edge, q in zip(edges, owner))


def test_skin_has_no_inner_faces():
    """Two hexahedra on each other with points of their own: 10 of 12 faces are outside."""
    faces = np.array(plot.HEX_FACES)
    place = np.concatenate([faces, faces + 4])  # the upper one's bottom is the lower one's top
    assert plot.used_once(place).sum() == 10


def test_round_off_has_no_colours():
    """A uniform field is drawn in one colour; small values that differ are not taken for uniform."""
    low, high = plot.colour_range(np.array([0.07, 0.07 + 1e-15]))
    assert high - low > 0.05
    assert plot.colour_range(np.array([1e-12, 3e-12])) == (1e-12, 3e-12) and plot.colour_range(np.zeros(3)) == (-0.5, 0.5)


def test_contact_is_drawn_on_one_side(run):
    """Of the two sides of the contact grid the one that carries the pressure, its points numbered anew."""
    result = run("inputs/blocks3d.yml")
    assert result.returncode == 0, result
    bulk, (contact,) = plot.states(result.directory, None)
    assert contact.cells.shape == (9, 4) and len(contact.X) == 16 and set(contact.cell["side"]) == {0} and contact.cells.max() == 15
    assert np.allclose(contact.point["normal"], (0, 0, -1)) and len(bulk.cells) == 26
    plot.plot_mesh(result.directory)
    assert (result.directory / "mesh.png").stat().st_size > 10000


def test_pressures_found(tmp_path):
    """Each over the volume or the way that it was found for, in a panel of their own."""
    history = {"t": [1, 2], "pressure.bore": [3, 5], "volume.bore": [0.1, 0.3], "pressure.lid": [7, 8], "advance.lid": [0.2, 0.4]}
    history = {name: np.array(values) for name, values in history.items()}
    figure, axis = plot.plt.subplots()
    plot.draw_pressures(axis, history, ["pressure.bore", "pressure.lid"])
    assert [line.get_xydata().tolist() for line in axis.lines] == [[[0.1, 3], [0.3, 5]], [[0.2, 7], [0.4, 8]]]
    assert axis.get_xlabel() == "advance, volume"
    (tmp_path / "history.csv").write_text("t,pressure.bore,volume.bore\n1,3,0.1\n")
    plot.plot_history(tmp_path)
    assert (tmp_path / "history.png").stat().st_size > 5000


def test_colours():
    """Of all values, of those between percentiles, or as given; what is no number does not count."""
    values = np.append(np.arange(101.0), np.nan)
    assert plot.colour_range(values) == (0, 100) and plot.colour_range(values, ("limits", 3, 4)) == (3, 4)
    assert plot.colour_range(values, ("percentile", 1, 99)) == (1, 99)


def draw(*words):
    """The script as it is started, in this process, which has loaded all that it draws with."""
    said, status = io.StringIO(), 0
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
        patch.setattr(sys, "argv", [str(SCRIPT), *map(str, words)])
        try:
            runpy.run_path(str(SCRIPT), run_name="__main__")
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else int(end.code is not None)
            if isinstance(end.code, str): said.write(end.code + "\n")
        plot.plt.close("all")
    return subprocess.CompletedProcess(words, status, "", said.getvalue())


def test_pictures_of_a_run(run, tmp_path):
    """Components, zoom, percentiles, the contact line, an animation, a chart of two runs, units on axes; what is not there is told."""
    options = ("-load_step", 0.5, "-units", "mm, N, MPa", "-adapt_tolerance", 0)
    one, two = (run("inputs/hertz2d.yml", *options, "-material_rubber_E", E).directory for E in (1, 2))
    alone = subprocess.run([sys.executable, "-B", str(SCRIPT), str(one), "--line"], capture_output=True, text=True)
    assert alone.returncode == 0 and not alone.stderr and (one / "line.png").stat().st_size > 5000, alone
    (one / "line.png").unlink()
    for words, file in (((one, "--field", "stress.1", "--percentile", 1, 99, "--zoom", -0.3, 0.3, 0.7, 1.2, "--time", 0.5), one / "mesh.png"), ((one, "--line"), one / "line.png"),
                        ((one, "--field", "displacement.norm", "--animate", tmp_path / "film.gif"), tmp_path / "film.gif"),
                        ((one, two, "--column", "contact_force", "--over", "energy"), one / "chart.png")):
        done = draw(*words)
        assert done.returncode == 0 and file.stat().st_size > 5000, done
    from PIL import Image
    assert Image.open(tmp_path / "film.gif").n_frames == 2
    for words, said in (((one, "--field", "stress"), "stress is no scalar; give stress.xx, stress.xy"), ((one, "--field", "none"), "no field none; there are displacement.x"),
                        ((one, "--animate", "film.avi"), ".gif or .mp4"), ((one, "--column", "none"), "no column none"), ((one, "--percentile", 5, 200), "range [0, 100]"),
                        ((one, "--animate", tmp_path / "none/a.gif"), "No such file or directory"), ((tmp_path,), "no fields.xdmf")):
        done = draw(*words)
        assert done.returncode == 1 and said in done.stderr and done.stderr.count("\n") == 1, done
    for words in ("--time", "nan"), ("--fps", 0), ("--zoom", "nan", 1, 0, 1):
        done = draw(one, *words)
        assert done.returncode == 2 and f"error: argument {words[0]}: invalid" in done.stderr, done


@pytest.mark.parametrize("name,hurt,said", [("fields.xdmf", lambda data: data[:300], "fields.xdmf is damaged"), ("fields_0001.h5", lambda data: data[:3000], "truncated file"),
                                            ("history.csv", lambda data: data + b"x,y\n", "history.csv: could not convert string to float: 'x'"),
                                            ("history.csv", lambda data: data + b"3,0.", None), ("fields.xdmf", None, "no fields.xdmf")])
def test_damaged_results(spoilt, name, hurt, said):
    """One sentence; a row that a kill cut off is none; without fields there is still the history."""
    whole = (spoilt / name).read_bytes()
    (spoilt / name).write_bytes(hurt(whole)) if hurt else (spoilt / name).unlink()
    done = draw(spoilt)
    (spoilt / name).write_bytes(whole)
    assert done.returncode == (said is not None) and (said or "") in done.stderr and done.stderr.count("\n") == (said is not None), done
    assert (spoilt / "history.png").exists() or name == "history.csv"


@pytest.fixture(scope="module")
def spoilt(tmp_path_factory):
    """Results of a run of two steps."""
    directory = tmp_path_factory.mktemp("spoilt") / "out"
    subprocess.run([PROGRAM, ROOT / "inputs/patch2d.yml", "-load_step", "0.5", "-output_directory", directory], capture_output=True, check=True)
    return directory


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="no ffmpeg")
def test_film_as_mp4(run, tmp_path):
    directory = run("inputs/patch2d.yml", "-load_step", 0.25).directory
    done = draw(directory, "--zoom", 0.1, 0.4, 0.1, 0.53, "--animate", tmp_path / "film.mp4")
    assert done.returncode == 0 and (tmp_path / "film.mp4").read_bytes()[4:8] == b"ftyp", done
    told = subprocess.run(["ffmpeg", "-i", tmp_path / "film.mp4", "-f", "null", "-"], capture_output=True, text=True).stderr
    assert "frame=    4" in told and "h264" in told, told


def test_contact_is_seen_from_outside(run):
    """Of a surface that looks down the eye is below it."""
    _, (contact,) = plot.states(run("inputs/blocks3d.yml").directory, None)
    azimuth, elevation = plot.facing(contact)
    assert plot.view(azimuth, elevation)[2] @ (0, 0, -1) > 0.8
