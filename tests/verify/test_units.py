"""Units of a scene (units): checked to agree, written into tables, field files and index; names of body, pair and side beside their numbers."""
import h5py
import pytest

UNITS = ("-units", "mm, N, MPa")


def test_written(run):
    result = run("inputs/patch2d.yml", *UNITS, "-output_quantities", "energy_density")
    assert result.returncode == 0 and result.summary["units"] == "mm, N, MPa", result
    head = (result.directory / "history.csv").read_text().split("\n")[0].split(",")
    for column in ("t", "cells", "energy [N]", "min_gap [mm]", "reaction.top.y [N/mm]", "reaction.top.moment [N]", "contact.upper_on_lower.max_pressure [MPa]",
                   "contact.upper_on_lower.area [mm]", "seconds"):  # per thickness
        assert column in head, head
    with h5py.File(result.directory / "fields_0000.h5") as file:
        assert file.attrs["units"] == b"mm, N, MPa" or file.attrs["units"] == "mm, N, MPa"
        text = {name: item.attrs["unit"] if "unit" in item.attrs else None for name, item in file["bulk"].items()}
        assert {name: unit if unit is None or isinstance(unit, str) else unit.decode() for name, unit in text.items() if name in ("stress", "displacement", "J", "energy_density")} == \
            {"stress": "MPa", "displacement": "mm", "J": None, "energy_density": "MPa"}
    index = (result.directory / "fields.xdmf").read_text()
    for fact in ('"units" Value="mm, N, MPa"', '"body" Value="lower, upper"', '"pair" Value="upper_on_lower"', '"side" Value="nonmortar, mortar"'):
        assert fact in index


def test_names_without_units(run):
    """Names are there in any case, units are not."""
    result = run("inputs/patch2d.yml")
    with h5py.File(result.directory / "fields_0000.h5") as file:
        assert [name.decode() for name in file["bulk/body"].attrs["names"]] == ["lower", "upper"]
        assert [name.decode() for name in file["contact/side"].attrs["names"]] == ["nonmortar", "mortar"]
        assert "units" not in file.attrs and "unit" not in file["bulk/stress"].attrs
    assert "[" not in (result.directory / "history.csv").read_text().split("\n")[0]


def test_goes_on(run):
    """A run with units is continued as any other, and not under other units."""
    first = run("inputs/hertz2d.yml", *UNITS, "-adapt_tolerance", 0, "-load_step", 0.5, "-load_max_steps", 1)
    again = run("inputs/hertz2d.yml", *UNITS, "-adapt_tolerance", 0, "-load_step", 0.5, "-restart", first.directory / "checkpoint.h5", "-output_directory", first.directory)
    assert again.returncode == 0 and (first.directory / "history.csv").read_text().count("\n") == 3, again


@pytest.mark.parametrize("units", ["mm, N, MPa", "m N Pa", "mm, mN, kPa", "um, uN", "in, lbf, psi", "m, kN, kPa"])
def test_agree(run, units):
    assert run("inputs/patch2d.yml", "-units", units, "-check").returncode == 0


@pytest.mark.parametrize("units, words", [
    ("mm, N, Pa", "Pa is not N/mm^2, which is MPa"), ("m, kgf, kPa", "kPa is not kgf/m^2, which is no unit of stress with a name of its own"), ("mm", "without a unit of force"),
    ("mm, m, N", "mm and m are both units of length"), ("mm, N, stone", "stone is no unit known here")])
def test_do_not_agree(run, units, words):
    result = run("inputs/patch2d.yml", "-units", units, "-check")
    assert result.returncode == 1 and result.stderr.startswith("mortise: ") and words in result.stderr and result.stderr.count("\n") == 1, result
