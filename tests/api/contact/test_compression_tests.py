"""Compression tests of foams in tables: what is read is what was measured, in every form of a file."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import contact, standards
from hrsafety.cli import main
from hrsafety.errors import HrsafetyError
from hrsafety.plausibility import HrsafetyWarning

THICKNESS, AREA = 0.025, 0.01
SIZES = {"thickness": THICKNESS, "area": AREA}
FOAM = contact.GibsonAshby(modulus=2.5e5, plateau=12e3, lock=0.85)
STRAIN = np.linspace(0.0, 0.7, 1500)


def stress_of(strain: np.ndarray) -> np.ndarray:
    """Return a curve with a plateau that rises at the end."""
    return 12e3 * (1.0 - np.exp(-20.0 * strain)) + 6e4 * strain**5


def written(folder: Path, header: str, *columns: np.ndarray, delimiter: str = ",") -> Path:
    place = folder / "press.csv"
    rows = [delimiter.join(f"{each:.9g}" for each in row) for row in zip(*columns, strict=True)]
    place.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return place


FORMS = {
    "strain and stress": ("strain_1,stress_Pa", 1.0, 1.0, {}),
    "strain without a dimension": ("Strain [-],Stress / Pa", 1.0, 1.0, {}),
    "crosshead": ("Crosshead [mm],Load [N]", 1e3 * THICKNESS, AREA, SIZES),
    "percent and kPa": ("Strain [%],Stress [kPa]", 100.0, 1e-3, {}),
    "N/mm^2": ("strain_percent,stress (N/mm^2)", 100.0, 1e-6, {}),
    "way and force": ("displacement_mm,force_N", 1e3 * THICKNESS, AREA, SIZES),
    "a row of units": (
        "Standardweg,Standardkraft\nmm,kN",
        1e3 * THICKNESS,
        1e-3 * AREA,
        {"thickness": THICKNESS, "area": AREA},
    ),
    "pull is positive": ("Displacement (mm),Load (N)", -1e3 * THICKNESS, -AREA, SIZES),
}


@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_the_same_material(tmp_path: Path, form: str) -> None:
    header, of_strain, of_stress, sizes = FORMS[form]
    found = contact.load_compression_test(
        written(tmp_path, header, of_strain * STRAIN, of_stress * stress_of(STRAIN)), **sizes
    )
    assert len(found.strain) <= 129
    assert (found.strain[0], found.stress[0]) == (0.0, 0.0)
    assert found.strain[-1] == pytest.approx(0.7, rel=0.02)
    np.testing.assert_allclose(found.stress, stress_of(np.asarray(found.strain)), rtol=0.02, atol=40.0)


def test_loads_with_it_are_those_of_the_whole_curve(tmp_path: Path) -> None:
    read = contact.load_compression_test(written(tmp_path, "strain_1,stress_Pa", STRAIN, stress_of(STRAIN)))
    whole = contact.StressTable(strain=STRAIN, stress=stress_of(STRAIN))
    limit = standards.limits().contact("chest", "transient")
    speeds = [
        contact.Contact(robot=8.0, body=limit, covering=contact.Covering(material=law, thickness=THICKNESS, area=6e-3))
        .allowed_speed()
        .speed
        for law in (read, whole)
    ]
    assert speeds[0] == pytest.approx(speeds[1], rel=5e-3)


def cycles(peaks: list[float], factors: list[float], rest: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return strain and stress of loadings up to peaks, each released to rest."""
    parts = []
    for peak in peaks:
        up = np.linspace(rest if parts else 0.0, peak, 800)
        parts.append(np.concatenate([up, np.linspace(peak, rest, 800)]))
    stress = [factor * stress_of(np.clip(part - rest, 0.0, None)) for factor, part in zip(factors, parts, strict=True)]
    return np.concatenate(parts), np.concatenate(stress)


@pytest.mark.parametrize("peaks", [[0.7, 0.7, 0.7], [0.7, 0.7001, 0.6999], [0.6, 0.7, 0.5]])
@pytest.mark.parametrize("which", ["first", "last"])
def test_a_loading_of_several_has_to_be_chosen(tmp_path: Path, peaks: list[float], which: str) -> None:
    press = written(tmp_path, "strain_1,stress_Pa", *cycles(peaks, [1.3, 1.05, 1.0]))
    with pytest.raises(HrsafetyError, match=r"must hold one loading, got 3; give loading"):
        contact.load_compression_test(press)
    found = contact.load_compression_test(press, loading=which)
    factor, peak = (1.3, peaks[0]) if which == "first" else (1.0, peaks[-1])
    assert found.strain[-1] == pytest.approx(peak, rel=0.02)
    np.testing.assert_allclose(found.stress, factor * stress_of(np.asarray(found.strain)), rtol=0.02, atol=60.0)
    with pytest.raises(HrsafetyError, match="loading must be one of"):
        contact.load_compression_test(press, loading="second")


def test_one_loading_may_be_asked_for_by_either_name(tmp_path: Path) -> None:
    press = written(tmp_path, "strain_1,stress_Pa", *cycles([0.7], [1.0]))
    assert (
        contact.load_compression_test(press)
        == contact.load_compression_test(press, loading="first")
        == contact.load_compression_test(press, loading="last")
    )


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), noise=st.floats(0.0, 0.01))
def test_noise_is_averaged(tmp_path_factory: pytest.TempPathFactory, seed: int, noise: float) -> None:
    draw = np.random.default_rng(seed)
    stress = stress_of(STRAIN) + noise * 2e4 * draw.standard_normal(len(STRAIN))
    stress[0] = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = contact.load_compression_test(
            written(tmp_path_factory.mktemp("press"), "strain_1,stress_Pa", STRAIN, stress)
        )
    assert (np.diff(found.stress) >= 0.0).all()
    np.testing.assert_allclose(found.stress[5:], stress_of(np.asarray(found.strain[5:])), atol=40.0 + noise * 2e4)


@pytest.mark.parametrize(
    ("header", "columns", "sizes", "words"),
    [
        ("strain_1,stress", (STRAIN, stress_of(STRAIN)), {}, "name the unit of each column, got 'stress'"),
        ("strain,stress_Pa", (STRAIN, stress_of(STRAIN)), {}, "name the unit of each column, got 'strain'"),
        ("strain_1,temperature", (STRAIN, STRAIN), {}, "a column with its unit that is called stress, .*, force, load"),
        ("time_s,force_N", (STRAIN, STRAIN), {"area": AREA}, "is called strain, .*, displacement, .*, crosshead"),
        ("strain_%,stress_Pa", (STRAIN, stress_of(STRAIN)), {}, "largest strain of at least 0.02 and below 1"),
        ("displacement_mm,stress_Pa", (10.0 * STRAIN, stress_of(STRAIN)), {"thickness": 25.0}, "largest strain of at"),
        ("displacement_mm,stress_Pa", (STRAIN, STRAIN), {}, "come with the thickness of the specimen"),
        ("strain_1,force_N", (STRAIN, STRAIN), {}, "come with the area of the specimen"),
        ("strain_1,force_N", (STRAIN, STRAIN), {"area": -1.0}, "area must be"),
        ("strain_1,stress_Pa", (100.0 * STRAIN, stress_of(STRAIN)), {}, "largest strain of at least 0.02 and below 1"),
        ("strain_1,stress_Pa", (STRAIN + 0.1, stress_of(STRAIN)), {}, "begin unloaded"),
        ("strain_1,stress_Pa", (STRAIN, stress_of(STRAIN) + 5e3), {}, "begin unloaded"),
        ("strain_1,stress_Pa", (STRAIN, STRAIN * (0.5 - STRAIN) + 0.14), {}, "begin unloaded"),
        ("strain_1,stress_Pa", (STRAIN, 1e4 * STRAIN * (0.8 - STRAIN)), {}, "does not fall"),
        ("strain_1,stress_Pa", (STRAIN[:1], STRAIN[:1]), {}, "at least two rows"),
        ("strain_1,strain_%,stress_Pa", (STRAIN, STRAIN, STRAIN), {}, "one column of strain"),
        (
            "strain_1,Kraft [lbf]",
            (STRAIN, STRAIN),
            {"area": AREA},
            "'Kraft .lbf.' in a unit that is known: n, kn, mn, dan",
        ),
        ("Weg,Kraft\nfurlong,N", (STRAIN, STRAIN), SIZES, "line 1 must have .* known: m, cm, mm, um, got 'furlong'"),
        ("Foam A\nstrain,stress", (STRAIN, STRAIN), {}, "line 2 must name the unit of each column, got 'strain'"),
        ("Foam A\nx,y", (STRAIN, STRAIN), {}, "delete the lines above the header"),
    ],
)
def test_what_is_no_test_is_refused(
    tmp_path: Path, header: str, columns: tuple[np.ndarray, ...], sizes: dict[str, float], words: str
) -> None:
    with pytest.raises(HrsafetyError, match=words):
        contact.load_compression_test(written(tmp_path, header, *columns), **sizes)


TITLES = {
    "one line": "Foam A",
    "cells": "Test;Foam A\nOperator;J. Doe\nThickness;25;mm\n",
    "words of both axes": "Kraft Weg Diagramm\n\nForce, displacement",
    "a comment": "# a press\nFoam A",
}


@pytest.mark.parametrize("titles", TITLES)
@pytest.mark.parametrize("form", FORMS)
def test_titles_above_the_header_are_left_out_and_told(tmp_path: Path, form: str, titles: str) -> None:
    header, of_strain, of_stress, sizes = FORMS[form]
    columns = (of_strain * STRAIN, of_stress * stress_of(STRAIN))
    plain = contact.load_compression_test(written(tmp_path, header, *columns), **sizes)
    line = TITLES[titles].count("\n") + 2
    with pytest.warns(HrsafetyWarning, match=f"press.csv: line {line} is taken as the header") as caught:
        found = contact.load_compression_test(written(tmp_path, f"{TITLES[titles]}\n{header}", *columns), **sizes)
    assert found == plain
    assert caught[0].filename == __file__


def test_a_header_below_titles_is_a_doubt_of_the_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], recwarn: pytest.WarningsRecorder
) -> None:
    written(tmp_path, "Foam A\ndisplacement_mm,force_N", 1e3 * THICKNESS * STRAIN, AREA * stress_of(STRAIN))
    cell, out = tmp_path / "cell.toml", tmp_path / "out"
    cell.write_text(
        'speed = 0.1\n[robot]\nmass = 8.0\n[[coverings]]\nname = "pad"\nthickness = 0.02\narea = 1e-3\n'
        f'material = {{law = "table", file = "press.csv", thickness = {THICKNESS}, area = {AREA}}}\n'
        '[[contacts]]\nregion = "chest"\ncontact = "transient"\ncovering = "pad"\n'
    )
    main(["contact", str(cell), "--out", str(out)])
    said = "press.csv: line 2 is taken as the header"
    assert said in capsys.readouterr().err
    for page in ("report.html", "report.json"):
        assert said in (out / page).read_text(encoding="utf-8")
    assert not recwarn.list


def test_decanewtons_are_ten_newtons(tmp_path: Path) -> None:
    columns = (1e3 * THICKNESS * STRAIN, AREA * stress_of(STRAIN))
    newtons = contact.load_compression_test(written(tmp_path, "Weg [mm];Kraft [N]", *columns, delimiter=";"), **SIZES)
    tens = written(tmp_path, "Weg [mm];Kraft [daN]", columns[0], 0.1 * columns[1], delimiter=";")
    np.testing.assert_allclose(contact.load_compression_test(tens, **SIZES).stress, newtons.stress, rtol=1e-6)


def test_a_cell_and_a_catalog_take_a_file(tmp_path: Path) -> None:
    press = written(tmp_path, "displacement_mm,force_N", 1e3 * THICKNESS * STRAIN, AREA * stress_of(STRAIN))
    law = contact.load_compression_test(press, thickness=THICKNESS, area=AREA)
    numbers = f'law = "table"\nfile = "press.csv"\nthickness = {THICKNESS}\narea = {AREA}\n'
    catalog = tmp_path / "foams.toml"
    catalog.write_text(f'[[materials]]\nname = "grey"\nsource = "press"\n{numbers}', encoding="utf-8")
    assert contact.load_materials(catalog)["grey"].law == law
    inline = "{ " + ", ".join(numbers.strip().split("\n")) + " }"
    cell = tmp_path / "cell.toml"
    for head, material in (("", inline), ('catalog = "foams.toml"\n', '"grey"')):
        cell.write_text(
            f'{head}speed = 0.2\ncovering = "pad"\n[robot]\nmass = 8.0\n[[coverings]]\nname = "pad"\n'
            f"material = {material}\nthickness = 0.02\narea = 4e-3\n"
            '[[contacts]]\nregion = "chest"\ncontact = "transient"\n',
            encoding="utf-8",
        )
        assert contact.load_cell(cell).coverings["pad"].material == law
    cell.write_text(cell.read_text().replace('"grey"', '{ law = "table", file = "gone.csv" }'), encoding="utf-8")
    with pytest.raises(HrsafetyError, match=r"gone\.csv"):
        contact.load_cell(cell)
