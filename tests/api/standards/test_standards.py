"""Limits of contact: the set that ships, sets of the user, and what is never silent."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import contact, standards
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ImplausibleWarning
from hrsafety.standards.sets import looser_than_published

ISO = standards.limits("iso_ts_15066_2016")


# ---- the set that ships ---------------------------------------------------------------------


def test_every_number_is_that_of_the_audited_data(shared: Path) -> None:
    data = json.loads((shared / "spec" / "contact_limits.json").read_text(encoding="utf-8"))["sets"][0]
    assert ISO.regions == tuple(each["region"] for each in data["regions"])
    for each in data["regions"]:
        region = each["region"]
        clamped, free = ISO.contact(region, "quasi_static"), ISO.contact(region, "transient")
        assert clamped.force == each["force_quasi_static_N"]
        assert clamped.force_limit.certainty == each["force_certainty"]
        assert clamped.force_limit.sources == tuple(each["force_sources"])
        assert clamped.spring_constant == 1e3 * each["spring_constant_N_per_mm"]
        assert clamped.spring.sources == tuple(each["spring_and_mass_sources"])
        assert free.body_mass == each["effective_mass_kg"]
        assert clamped.body_mass == math.inf
        if each["transient_factor"] is None:
            assert free.status == "not_permitted"
        else:
            assert free.force == each["transient_factor"] * each["force_quasi_static_N"]
    for each in data["areas"]:
        area = each["area"] if each["side"] is None else f"{each['area']}, {each['side']}"
        found = ISO.contact(each["region"], "quasi_static", area=area)
        assert found.pressure == pytest.approx(1e4 * each["pressure_quasi_static_N_per_cm2"], rel=1e-15)
        assert found.pressure_limit.certainty == each["certainty"]
        assert found.pressure_limit.sources == tuple(each["sources"])
    assert len(ISO.areas()) == len(data["areas"]) == 29


@pytest.mark.parametrize(("region", "pressure"), [("hand_finger", 190), ("thigh_knee", 220), ("lower_leg", 210)])
def test_pressure_of_a_region_is_the_smallest_of_its_areas(region: str, pressure: float) -> None:
    found = ISO.contact(region, "quasi_static")
    assert found.pressure == pressure * 1e4
    assert ISO.contact(region, "transient").pressure == 2 * pressure * 1e4
    assert found.pressure_area in ISO.areas(region)


def test_an_area_without_its_side_is_the_weaker_side() -> None:
    assert ISO.contact("hand_finger", "quasi_static", area="forefinger pad").pressure == 270e4
    assert ISO.contact("hand_finger", "quasi_static", area="forefinger pad, dominant").pressure == 300e4
    assert ISO.contact("thigh_knee", "quasi_static", area="kneecap").force == 220.0


@pytest.mark.parametrize("region", ["skull_forehead", "face"])
def test_transient_contact_of_the_head_is_not_permitted_and_has_no_number(region: str) -> None:
    limit = ISO.contact(region, "transient")
    assert (limit.force, limit.pressure, limit.status) == (None, None, "not_permitted")
    assert limit.verdict(force=0.0, pressure=0.0).overall == "not_permitted"
    assert limit.force_verdict([0.0, 1e9]).tolist() == ["not_permitted"] * 2
    assert limit.force_margin([1.0]) is None
    assert "not permitted" in str(limit)
    assert ISO.contact(region, "quasi_static").status == "limited"


def test_edition_and_certainty_stand_in_every_output() -> None:
    limit = ISO.contact("pelvis", "quasi_static")
    assert "edition 2016" in str(limit)
    assert "force: single_source" in limit.notes
    assert ISO.contact("neck").certainty == dict.fromkeys(
        ("force", "pressure", "spring_constant", "effective_mass"), "certain"
    )
    table = ISO.columns()
    assert set(table["edition"]) == {"2016"}
    numbers = ~np.isnan(table["force_N"])
    assert all(table["force_certainty"][numbers])
    assert all(table["force_sources"][numbers])
    assert "2016 values" in ISO.note or "values of 2016" in ISO.note


def test_every_source_of_the_set_is_explained() -> None:
    used = {
        tag
        for row in ISO.rows
        for each in (row.force, row.pressure, row.spring_constant)
        if each
        for tag in each.sources
    }
    assert used <= set(ISO.sources)


def test_a_limit_that_was_not_checked_never_counts_as_kept() -> None:
    limit = ISO.contact("chest", "transient")
    assert limit.verdict(force=100.0).overall == "not_checked"
    assert limit.verdict(force=100.0, pressure=1e5) == ("within_limits",) * 3
    assert limit.verdict(force=281.0).overall == "exceeds"
    assert limit.verdict().overall == "not_checked"
    assert limit.force_verdict([280.0, 280.1, math.inf]).tolist() == ["within_limits", "exceeds", "exceeds"]
    with pytest.raises(InvalidParameterError, match="force must be at least 0, got nan"):
        limit.force_verdict(math.nan)


@settings(max_examples=100, deadline=None)
@given(
    force=st.floats(100.0, 3000.0),
    area=st.floats(2e-5, 5e-3),
    slips=st.tuples(st.sampled_from([1.0, 1e-3]), st.sampled_from([1.0, 1e-3, 1e-4, 1e-6])),
)
def test_loads_that_are_too_large_are_never_kept_in_another_unit(
    force: float, area: float, slips: tuple[float, float]
) -> None:
    """One of both in kN, kPa, N/cm^2 or MPa; both at once fit each other, and only small numbers tell."""
    limit = ISO.contact("chest", "quasi_static")
    pressure = force / area
    if force > 140.0 or pressure > 120e4:
        assert (
            slips == (1.0, 1.0)
            or 1.0 not in slips
            or limit.verdict(force=force * slips[0], pressure=pressure * slips[1]).overall != "within_limits"
        )


def test_loads_of_exactly_0_are_not_kept() -> None:
    limit = ISO.contact("chest", "transient")
    found = limit.verdict(force=0.0, pressure=0.0)
    assert (found.overall, {each.code for each in found.warnings}) == ("not_checked", {"no_push"})
    assert limit.verdict(force=5.0, pressure=1e5).overall == "within_limits"
    with pytest.warns(ImplausibleWarning, match="what was not measured is not kept"):
        assert limit.force_verdict([0.0, 0.0]).tolist() == ["not_checked", "not_checked"]
    assert limit.force_verdict([0.0, 20.0]).tolist() == ["within_limits", "within_limits"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ches",), r'region must be one of .*did you mean "chest"'),
        (("chest", "clamped"), r'contact must be one of "quasi_static", "transient"'),
        (("chest", "transient", "kneecap"), r'area must be one of "sternum", "pectoral muscle", got \'kneecap\''),
    ],
)
def test_unknown_words_are_refused(arguments: tuple[str, ...], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        ISO.contact(*arguments[:2], **({"area": arguments[2]} if len(arguments) > 2 else {}))
    with pytest.raises(InvalidParameterError, match=r'did you mean "iso_ts_15066_2016"'):
        standards.limits("iso_ts_15066_2018")


# ---- sets of the user -----------------------------------------------------------------------

HEADER = ",".join(standards.template().strip().split(","))
ROWS = [
    "chest,,transient,100,,25,40,own tests,certain",
    "chest,sternum,transient,,60,,,own tests,likely",
    "chest,ribs,transient,90,80,,,own tests,",
    "face,,transient,not_permitted,,75,4.4,rule of the plant,certain",
    "arm,,quasi_static,,,30,,own tests,certain",
]


def own(tmp_path: Path, *rows: str, header: str = HEADER) -> standards.LimitSet:
    path = tmp_path / "own.csv"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return standards.limits(path)


def test_a_set_of_the_user_from_csv(tmp_path: Path) -> None:
    found = own(tmp_path, *ROWS)
    assert found.regions == ("chest", "face", "arm")
    chest = found.contact("chest", "transient")
    assert (chest.force, chest.pressure, chest.pressure_area) == (90.0, pytest.approx(60e4), "sternum")
    assert found.contact("chest", "transient", area="sternum").force == 100.0
    assert found.contact("chest", "transient", area="ribs").certainty["force"] == "not_stated"
    assert "edition not given" in str(chest)
    assert found.contact("face", "transient").status == "not_permitted"
    # No number at all, and a class of contact without a row: not checked, and said.
    assert found.contact("arm", "quasi_static").status == "not_checked"
    assert found.contact("chest", "quasi_static").status == "not_checked"
    assert "force: not_checked, the set has no limit" in found.contact("arm", "quasi_static").notes


def test_the_same_set_from_toml(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(
        'id = "plant"\ntitle = "Own limits"\nedition = "2025-03"\n[[limits]]\nregion = "chest"\ncontact = "transient"\n'
        'force_N = 100\nspring_constant_N_per_mm = 25.0\neffective_mass_kg = 40\nsource = "tests"\n'
    )
    limit = standards.limits(path).contact("chest", "transient")
    assert (limit.set_id, limit.edition, limit.force) == ("plant", "2025-03", 100.0)
    assert limit.force == own(tmp_path, *ROWS).contact("chest", "transient", area="sternum").force


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("chest,,transient,100,,,,,certain", r"own.csv: line 2: source must be given"),
        ("chest,,transient,-1,,,,tests,", r"own.csv: line 2: force_N must be finite and positive, got '-1'"),
        ("chest,,transient,0,,,,tests,", r"line 2: force_N must be finite and positive"),
        ("chest,,transient,nan,,,,tests,", r"line 2: force_N must be a number, got 'nan'"),
        ("chest,,transient,1e999,,,,tests,", r"line 2: force_N must be finite and positive"),
        ("chest,,transient,1_0,,,,tests,", r"line 2: force_N must be a number"),
        ("chest,,transient,100 N,,,,tests,", r"line 2: force_N must be a number"),
        ("chest,,clamped,100,,,,tests,", r"line 2: contact must be one of"),
        (",,transient,100,,,,tests,", r"line 2: region must be given"),
        ("chest,,transient,100,,,,tests,sure", r"line 2: certainty must be one of"),
        ("chest,,transient,100,,,,tests", r"line 2 must have 9 cells, got 8"),
        ("face,,transient,not_permitted,50,,,tests,", r"line 2: pressure_N_per_cm2 must be left out where"),
        ('"chest,,transient', r"must be a row of CSV"),
    ],
)
def test_bad_rows_are_named(tmp_path: Path, row: str, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        own(tmp_path, row)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        (
            "region,contact,force,source",
            r"header must have no other columns .* got 'force'; (did you mean|columns carry)",
        ),
        ("region,contact,force_N", r"header must have a column source"),
        ("region,contact,source,source", r"header must have a column once, got 'source'"),
    ],
)
def test_bad_headers_are_named(tmp_path: Path, header: str, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        own(tmp_path, "chest,transient,100,tests", header=header)


def test_rows_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InvalidParameterError, match=r"line 3 must not say again what line 2 says, got chest, transient"
    ):
        own(tmp_path, ROWS[0], ROWS[0])
    other = "chest,sternum,transient,,60,26,,own tests,"
    with pytest.raises(InvalidParameterError, match=r"line 3: spring_constant must be the same in all rows of chest"):
        own(tmp_path, ROWS[0], other)
    # Read as a region of its own, this row would limit nothing of the chest.
    stricter = "Chest,,quasi_static,50,,,,own tests,"
    refused = r"line 3: region must be spelled as above \('chest'\), got 'Chest'"
    with pytest.raises(InvalidParameterError, match=refused):
        own(tmp_path, ROWS[0], stricter)
    with pytest.raises(InvalidParameterError, match=r"file must have rows"):
        own(tmp_path)


@pytest.mark.parametrize("place", ["", "sternum"])
def test_a_clamped_part_bears_no_more_than_a_free_one(tmp_path: Path, place: str) -> None:
    clamped, free = f"chest,{place},quasi_static,280,,,,tests,", f"chest,{place},transient,140,,,,tests,"
    for rows in ((clamped, free), (free, clamped)):
        words = r"line 3: force must be at most as high for quasi_static as for transient \(140 N\), got 280 N"
        with pytest.raises(InvalidParameterError, match=words):
            own(tmp_path, *rows)
    assert own(tmp_path, clamped, free.replace("140", "280")).contact("chest", "transient").force == 280.0


@pytest.mark.parametrize(
    ("row", "found"),
    [
        ("chest,,transient,280,,,,tests,", []),
        ("chest,,transient,281,,,,tests,", ["limits.force"]),
        ("chest,,transient,,400,,,tests,", ["limits.pressure"]),
        ("chest,,transient,500,400,,,tests,", ["limits.force", "limits.pressure"]),
        ("face,,transient,50,,,,tests,", ["limits"]),  # no such contact is permitted
        ("hand_finger,,transient,100,,75,0.6,tests,", []),
        ("hand_finger,,transient,100,,74.9,0.6,tests,", ["limits.spring_constant"]),
        ("hand_finger,,transient,100,,7.5,0.5,tests,", ["limits.spring_constant", "limits.effective_mass"]),
        ("hand_finger,,transient,100,,750,6,tests,", []),  # stiffer and heavier allow less
        ("tail,,transient,5000,,,,tests,", []),  # nothing to compare with
    ],
)
def test_numbers_that_allow_more_than_the_published_ones_are_doubted(
    tmp_path: Path, row: str, found: list[str]
) -> None:
    region, _, kind = row.split(",")[:3]
    limit = own(tmp_path, row).contact(region, kind)
    more = {} if limit.spring is not None else {"body": 40.0, "region": 25e3}
    hit = contact.Contact(robot=8.0, area=1e-4, **({"body": limit} | more))
    doubts = [each for each in hit.allowed_speed(limit).warnings if each.code == "looser_than_published"]
    assert [each.subject for each in doubts] == found
    assert not any(each.safe_side for each in doubts)


def over_base(folder: Path, *rows: str, head: str = "") -> standards.LimitSet:
    path = folder / "own.toml"
    tables = "".join(f"[[limits]]\n{row}\n" for row in rows)
    path.write_text(f'base = "iso_ts_15066_2016"\n{head}{tables}', encoding="utf-8")
    return standards.limits(path)


def test_a_base_without_rows_says_what_is_needed(tmp_path: Path) -> None:
    words = (
        r"own.toml: limits must be tables \[\[limits\]\], .*region, contact, source.*take 'iso_ts_15066_2016' itself"
    )
    with pytest.raises(InvalidParameterError, match=words):
        over_base(tmp_path)
    (tmp_path / "own.toml").write_text('title = "mine"\n', encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=r"region, contact, source and loads$"):
        standards.limits(tmp_path / "own.toml")


def test_rows_over_a_base_change_what_they_say(tmp_path: Path) -> None:
    row = 'region = "hand_finger"\ncontact = "transient"\nforce_N = 200.0\nsource = "own tests"'
    found = over_base(tmp_path, row)
    assert (found.id, found.regions, found.areas()) == ("own", ISO.regions, ISO.areas())
    hand, same = found.contact("hand_finger", "transient"), found.contact("hand_finger", "quasi_static")
    assert (hand.force, hand.force_limit.sources) == (200.0, ("own tests",))
    whole = ISO.contact("hand_finger", "transient")
    assert (hand.pressure, hand.spring_constant, hand.body_mass) == (
        whole.pressure,
        whole.spring_constant,
        whole.body_mass,
    )
    assert same.force == ISO.contact("hand_finger", "quasi_static").force
    others = [region for region in ISO.regions if region != "hand_finger"]
    for region in others:
        for kind in ("quasi_static", "transient"):
            assert found.contact(region, kind).force == ISO.contact(region, kind).force
    # A spring is that of the whole region, and what is forbidden has no numbers.
    stiff = over_base(tmp_path, row + "\nspring_constant_N_per_mm = 90.0").contact("hand_finger", "quasi_static")
    assert stiff.spring_constant == 9e4
    none = 'region = "chest"\ncontact = "transient"\nforce_N = "not_permitted"\nsource = "own rule"'
    assert over_base(tmp_path, none).contact("chest", "transient").status == "not_permitted"


@pytest.mark.parametrize(
    ("row", "head", "words"),
    [
        (
            'region = "hand"\ncontact = "transient"\nforce_N = 1.0',
            "",
            r"limits\[0\] must be a row of iso_ts_15066_2016",
        ),
        ('region = "chest"\narea = "heart"\ncontact = "transient"\nforce_N = 1.0', "", "must be a row of iso"),
        (
            'region = "chest"\ncontact = "transient"\nforce_N = 100.0',
            "",
            "at most as high for quasi_static as for trans",
        ),
        (
            'region = "chest"\ncontact = "quasi_static"\nforce_N = 300.0',
            "",
            "at most as high for quasi_static as for trans",
        ),
        ('region = "chest"\ncontact = "transient"\nforce_N = 200.0', 'id = "iso_ts_15066_2016"\n', "id must differ"),
    ],
)
def test_rows_that_do_not_fit_a_base_are_refused(tmp_path: Path, row: str, head: str, words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        over_base(tmp_path, row + '\nsource = "own tests"', head=head)


def test_an_area_is_compared_with_itself(tmp_path: Path) -> None:
    areas = {
        name: ISO.contact("hand_finger", "transient", area=name).pressure or 0.0 for name in ISO.areas("hand_finger")
    }
    weak, strong = min(areas, key=areas.__getitem__), max(areas, key=areas.__getitem__)
    between = 0.5e-4 * (areas[weak] + areas[strong])
    row = f'region = "hand_finger"\narea = "{weak}"\ncontact = "transient"\nsource = "own"\n'
    row += f"pressure_N_per_cm2 = {between}"
    (doubt,) = looser_than_published(over_base(tmp_path, row).contact("hand_finger", "transient", area=weak))
    assert doubt.subject == "limits.pressure"
    assert looser_than_published(over_base(tmp_path, row).contact("hand_finger", "transient", area=strong)) == ()


@pytest.mark.parametrize("kind", ["csv", "toml"])
def test_a_template_has_the_columns_and_no_values(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"empty.{kind}"
    path.write_text(standards.template(kind))
    with pytest.raises(InvalidParameterError):
        standards.limits(path)
    assert all(column in standards.template(kind) for column in HEADER.split(","))
    assert not any(character.isdigit() for character in standards.template("csv").replace("cm2", ""))


def test_separations_of_numbers_without_a_quotient_are_refused() -> None:
    extreme = {"reaction_time": 0.1, "deceleration": 1e-308, "human_speed": 0.0}
    with pytest.raises(InvalidParameterError, match="robot_speed must have an answer"):
        standards.separation_distance(1e308, **extreme)
    with pytest.raises(InvalidParameterError, match=r"robot_speed\[1\] must have an answer"):
        standards.separation_distance([1.0, 1e308], **extreme)
