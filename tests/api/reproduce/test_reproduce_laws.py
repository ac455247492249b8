from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from api.read_pages import page_of
from hrsafety import navigation as nav
from hrsafety import reproduce
from hrsafety.reproduce import parts, tables
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.laws import claims as laws_claims
from hrsafety.reproduce.laws import compared as laws_compared
from hrsafety.reproduce.laws import study as laws_study
from hrsafety.reproduce.laws.compared import COMPARED, FORCES, LIKE_SOURCE, PLANNERS

WALKS = 12
# Times and distances that the specification gives are rounded to 0.01 s and 1 mm.
TIME, DISTANCE = 0.01, 0.003
MASOUD = {
    "6.2": (6.34, {"d_circle_min": 0.696}),
    "6.3": (7.15, {"d_human_min": 1.037}),
    "6.4": (7.66, {"d_rectangle_min": 0.708, "d_circle_min": 0.633}),
    "6.5": (7.62, {"d_human_min": 1.248, "d_rectangle_min": 0.708, "d_circle_min": 0.690}),
}
GE_CUI = {"6.2": {"d_circle_min": 0.732}, "6.4": {"d_rectangle_min": 0.734, "d_circle_min": 0.748}}


@pytest.fixture(scope="module")
def study() -> laws_study.LawsStudy:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(laws_study, "WALKS", WALKS)
        return laws_study.compare()


@pytest.fixture(scope="module")
def places() -> dict[tuple[str, str, str], PrintedValue]:
    cells = [*tables.chapter_6(), *tables.unpredictable_human()]
    return {(cell.table, cell.row, cell.column): cell for cell in cells}


@pytest.fixture(scope="module")
def claims(study: laws_study.LawsStudy) -> list[PrintedValue]:
    return laws_claims.cells(study)


# ---- rows of the tables -----------------------------------------------------------------------------


@pytest.mark.parametrize("table", MASOUD)
def test_rows_of_masoud_are_those_of_the_specification(
    table: str, places: dict[tuple[str, str, str], PrintedValue]
) -> None:
    time, distances = MASOUD[table]
    arrival = places[table, "masoud", "T_arrive"]
    assert arrival.measured == pytest.approx(time, rel=TIME)
    assert arrival.within
    assert places[table, "masoud", "H"].within
    for column, distance in distances.items():
        assert places[table, "masoud", column].measured == pytest.approx(distance, abs=DISTANCE)


def test_rows_of_masoud_agree_with_print_but_for_one_named_distance(
    places: dict[tuple[str, str, str], PrintedValue],
) -> None:
    off = [
        place for place, cell in places.items() if place[0] != "5.1" and place[1] == "masoud" and cell.within is False
    ]
    assert off == [("6.5", "masoud", "d_circle_min")]
    assert places[off[0]].reason


@pytest.mark.parametrize("table", GE_CUI)
def test_distances_of_ge_and_cui_agree_beside_stationary_obstacles(
    table: str, places: dict[tuple[str, str, str], PrintedValue]
) -> None:
    for column, distance in GE_CUI[table].items():
        cell = places[table, "ge_cui", column]
        assert cell.measured == pytest.approx(distance, rel=TIME)
        assert cell.within


def test_no_verdict_on_times_energies_and_scores_of_ge_and_cui(
    places: dict[tuple[str, str, str], PrintedValue],
) -> None:
    shown = [cell for (table, row, _), cell in places.items() if row == "ge_cui" and table != "6.1"]
    free = [cell for cell in shown if not cell.column.startswith("d_")]
    assert len(free) == 4 * 3
    for cell in free:
        assert cell.within is None
        assert isinstance(cell.measured, float)
        assert "no verdict" in cell.reason
    assert all(cell.within is not None for cell in shown if cell.column.startswith("d_"))


def test_every_row_of_a_simulated_law_has_a_measured_value(places: dict[tuple[str, str, str], PrintedValue]) -> None:
    for (table, row, _), cell in places.items():
        if table != "6.1" and not row.endswith("_experiment"):
            assert cell.measured is not None, cell


# ---- the varied walk --------------------------------------------------------------------------------


def test_walk_follows_from_its_seed_alone() -> None:
    assert laws_compared.varied_walk(3) == laws_compared.varied_walk(3)
    assert laws_compared.varied_walk(3) != laws_compared.varied_walk(4)


def test_walks_stay_within_the_stated_ranges_and_use_them() -> None:
    drawn: list[list[float]] = [[] for _ in range(7)]
    starts, speeds, times, slowing, leaving, reached, courses = drawn
    for seed in range(200):
        (person,) = laws_compared.varied_walk(seed).obstacles
        assert isinstance(person, nav.Human)
        assert person.segments is not None
        walk, stop, away = person.segments
        starts.append(person.start[0])
        speeds.append(walk[1][0])
        times.append(walk[0])
        slowing.append(-stop[2][0])
        assert stop[0] * stop[2][0] == pytest.approx(-walk[1][0])
        acceleration = np.hypot(*away[2])
        leaving.append(float(acceleration))
        reached.append(float(acceleration * away[0]))
        courses.append(float(np.degrees(np.arctan2(away[2][1], away[2][0]))))
    for values, (low, high) in (
        (starts, (0.3, 0.9)),
        (speeds, (0.7, 1.0)),
        (times, (0.5, 2.0)),
        (slowing, (0.5, 2.0)),
        (leaving, (0.5, 2.0)),
        (reached, (0.5, 1.0)),
        (np.abs(courses).tolist(), (60.0, 120.0)),
    ):
        room = 0.03 * (high - low)
        assert low - 1e-9 <= min(values) < low + room
        assert high - room < max(values) <= high + 1e-9
    assert 80 < sum(course > 0.0 for course in courses) < 120


def test_printed_walk_is_among_what_the_generator_can_draw() -> None:
    (person,) = laws_compared.printed_walk().obstacles
    assert isinstance(person, nav.Human)
    assert person.segments is not None
    (time, velocity, _), (_, _, slowing), (_, _, away) = person.segments
    assert (person.start, time, velocity, slowing, away) == ((0.6, 0.0), 1.0, (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0))


# ---- the comparison ---------------------------------------------------------------------------------


def test_nine_laws_and_the_rule_of_the_source_meet_every_walk(study: laws_study.LawsStudy) -> None:
    assert (len(FORCES), len(PLANNERS), len(LIKE_SOURCE)) == (5, 4, 1)
    assert set(study.printed) == set(study.varied) == {*COMPARED, *LIKE_SOURCE}
    assert all(len(many.contact) == WALKS for many in study.varied.values())
    for entry in COMPARED.values():
        assert entry.law == type(entry.law)()


def test_contacts_are_those_of_the_batch(study: laws_study.LawsStudy) -> None:
    walks = [laws_compared.varied_walk(seed) for seed in range(WALKS)]
    for name, entry in COMPARED.items():
        table, many = nav.simulate_batch(walks, entry.law), study.varied[name]
        assert np.array_equal(many.contact, table.outcome == "collided"), name
        assert np.array_equal(many.contact & ~many.standing, table.contacts_moving > 0), name
        assert many.least_distance == pytest.approx(table.min_distance[:, 0], abs=1e-9), name
        assert np.array_equal(many.contact, many.least_distance <= 0.6), name


def test_same_study_again_is_the_same_to_the_last_bit(
    study: laws_study.LawsStudy, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(laws_study, "WALKS", WALKS)
    again = laws_study.compare()
    assert laws_study.rows(again) == laws_study.rows(study)
    assert laws_claims.cells(again) == laws_claims.cells(study)


def test_new_field_differs_from_itself_in_no_walk(study: laws_study.LawsStudy) -> None:
    assert laws_study.compared_contacts(study, "new_vff") == (0, 0, 1.0)


def test_masoud_touches_the_parallel_person_and_the_new_field_does_not(study: laws_study.LawsStudy) -> None:
    assert study.parallel["masoud"].contact_time[0] == pytest.approx(2.73, abs=0.005)
    assert study.parallel["new_vff"].outcome == study.parallel["masoud_twice"].outcome == "arrived"


# ---- demonstrations ---------------------------------------------------------------------------------


def test_only_laws_that_turn_aside_leave_the_collinear_condition(study: laws_study.LawsStudy) -> None:
    passing = {name for name, shown in study.demonstrations.items() if shown.standing.outcome == "arrived"}
    assert passing == {"new_vff", "masoud"}
    stuck = study.demonstrations["khatib"].standing
    assert np.ptp(stuck.position[:, 1]) == 0.0


def test_person_in_the_collinear_condition_is_touched_at_the_known_instant(study: laws_study.LawsStudy) -> None:
    assert study.demonstrations["ge_cui"].walking.contact_time[0] == pytest.approx(3.02, abs=0.005)


def test_jump_at_the_edge_follows_from_the_formula_of_each_law(study: laws_study.LawsStudy) -> None:
    masoud, koren, ge_cui = nav.Masoud(), nav.BorensteinKoren(), nav.GeCui()
    active, surfaces, speed, most = 0.8, 0.8 - 0.1 - 0.2, 0.7, 10.0
    reach = active - speed**2 / (2.0 * most)
    expected = {
        "new_vff": 0.0,
        "khatib": 0.0,
        "masoud": active * float(np.hypot(masoud.repulsive_gain, masoud.detour_gain)),
        "borenstein_koren": koren.repulsive_gain / surfaces,
        "ge_cui": ge_cui.repulsive_gain * (1.0 + speed / most) / reach**2,
    }
    for name, jump in expected.items():
        assert study.demonstrations[name].jump == pytest.approx(jump, rel=1e-6, abs=1e-6), name


def test_crossings_and_way_back_are_counted_on_the_recorded_path(study: laws_study.LawsStudy) -> None:
    run = study.demonstrations["new_vff"].beside
    straight = replace(run, position=np.linspace((3.9, 0.6), (0.0, 0.6), len(run.time)))
    assert laws_study.way_back(straight) == 0.0
    inside_twice = np.array([[1.0], [0.7], [0.9], [0.7], [0.6], [1.2]])
    assert laws_study.crossings(replace(run, distance=inside_twice)) == 4


# ---- claims, pictures, page -------------------------------------------------------------------------


def test_claims_say_why_they_do_not_hold(claims: list[PrintedValue]) -> None:
    assert {cell.table for cell in claims} == set(laws_claims.TABLES)
    assert all(cell.within is not None for cell in claims)
    assert [cell for cell in claims if not cell.within and not cell.reason] == []
    assert 0 < sum(bool(cell.within) for cell in claims) < len(claims)


def test_verdicts_on_contacts_follow_from_the_runs(claims: list[PrintedValue], study: laws_study.LawsStudy) -> None:
    walked = {cell.row: cell for cell in claims if (cell.table, cell.column) == ("Section 5.7", "printed walk")}
    for label, name in (("VO", "time_and_risk"), ("RRT", "random_tree"), ("Field D*", "field_d_star")):
        assert walked[label].within is bool(np.isfinite(study.printed[name].contact_time[0]))
    for name in ("masoud", "ge_cui", "new_vff"):
        assert walked[COMPARED[name].label].within is (study.printed[name].outcome == "arrived")


@pytest.fixture(scope="module")
def made(study: laws_study.LawsStudy) -> parts.Made:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(laws_study, "compare", lambda _: study)
        return parts.PARTS["laws"].make(print)


def test_pictures_have_names_and_captions(made: parts.Made) -> None:
    pictures = made.pictures
    names = [picture.name for picture in pictures]
    assert len(set(names)) == len(names) == 8
    for number in ("2.5", "2.6", "5.11", "5.12", "6.19", "6.20"):
        assert any(name.startswith(f"figure-{number}-") for name in names), number
    assert all(picture.caption.endswith(".") and picture.png.startswith(b"\x89PNG") for picture in pictures)


def test_page_shows_every_law_and_claim_and_counts_them(
    made: parts.Made, claims: list[PrintedValue], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = replace(parts.PARTS["laws"], make=lambda _: made)
    monkeypatch.setattr(parts, "PARTS", {**parts.PARTS, "laws": drawn})
    text = reproduce.run(tmp_path, only="laws").read_text(encoding="utf-8")
    page = page_of(text)
    shown = " ".join(page.texts)
    assert all(entry.label in shown for entry in COMPARED.values())
    assert all(str(cell.measured) in shown for cell in claims if isinstance(cell.measured, str))
    assert all(cell.reason in shown for cell in claims)
    within = sum(bool(cell.within) for cell in claims)
    assert f"{within} of {len(claims)} judged values are within tolerance" in shown
    assert page.images == len(list((tmp_path / "figures").iterdir())) == 8
    written = json.loads((tmp_path / "laws.json").read_text(encoding="utf-8"))
    with (tmp_path / "laws.csv").open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    assert [row["law"] for row in written] == [line["law"] for line in lines]
    assert len(written) == len(COMPARED) + len(LIKE_SOURCE)
