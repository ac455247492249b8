"""What measured numbers and guides say of shares of contacts is what the tables beside them hold."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import measure_shares
from hrsafety import navigation as nav
from measure_laws import LAWS
from page_tables import shares, written

REPOSITORY = Path(__file__).resolve().parents[2]
VALIDATION = (REPOSITORY / "docs" / "validation.md").read_text(encoding="utf-8")
MEASURED = (REPOSITORY / "docs" / "measured.md").read_text(encoding="utf-8")
FIRST_RUN = (REPOSITORY / "docs" / "guides" / "first_run.md").read_text(encoding="utf-8")
TABLES = written(VALIDATION, measure_shares.MARKS)
GUIDES = sorted((REPOSITORY / "docs" / "guides").glob("*.md"))


def table(title: str) -> dict[str, list[str]]:
    """Return the cells of the table below a title, by law."""
    rows = TABLES.split(f"{title}\n\n")[1].split("\n\n")[0].splitlines()[2:]
    return {cells[0]: cells[1:] for cells in (row.strip("| ").split(" | ") for row in rows)}


def toward(cell: str) -> str:
    """Return the percentage of runs in which the robot moves toward whom it touches."""
    return cell.split("; ")[0].split()[0]


def away(cell: str) -> str:
    """Return the percentage of other runs in which somebody touches it while it moves away."""
    return cell.split("; ")[1].split()[0]


def standing(cell: str) -> str:
    """Return the percentage of runs with a contact only while the robot stands."""
    return cell.split("; ")[-1].split()[0]


CONDITIONS = {each: table(each.title) for each in measure_shares.CONDITIONS}


@pytest.mark.parametrize("condition", measure_shares.CONDITIONS, ids=lambda each: each.title)
def test_table_of_encounters_has_every_law_and_sensing(condition: measure_shares.Condition) -> None:
    rows = CONDITIONS[condition]
    by_regions = condition in measure_shares.CONDITIONS[2:]
    assert set(rows) == set(measure_shares.FIELD_LAWS if by_regions else LAWS)
    assert all(len(cells) == 1 + 2 * len(measure_shares.SENSINGS) for cells in rows.values())


@pytest.mark.evidence
@pytest.mark.parametrize("name", ["New field", "Velocity obstacle", "ORCA"])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_shares_of_encounters_are_what_is_computed(name: str, column: int) -> None:
    condition = measure_shares.CONDITIONS[1]
    measurement = list(measure_shares.SENSINGS.values())[column]
    ways = measure_shares.crossings(measure_shares.ENCOUNTERS, condition.fastest)
    scenes = [measure_shares.encounter(way, condition, measurement, seed) for seed, way in enumerate(ways)]
    cell = CONDITIONS[condition][name][1 + 2 * column]
    assert shares(nav.simulate_batch(scenes, LAWS[name])) == cell


@pytest.mark.parametrize("name", ["New field", "ORCA", "Velocity obstacle"])
@pytest.mark.parametrize("people", [1, 3, 12])
def test_measured_numbers_print_the_shares_of_all_sensings(people: int, name: str) -> None:
    if people == 1:
        number, *cells = CONDITIONS[measure_shares.CONDITIONS[1]][name]
        shares = cells[::2]
    else:
        number, *shares = table(measure_shares.crowd_title(people))[name]
    scene = "one person of up to 1.6 m/s" if people == 1 else f"{people} people of up to 1.0 m/s"
    law = {"New field": "virtual force field", "Velocity obstacle": "velocity obstacle"}.get(name, name)
    assert f"| {scene} | {law} | {int(number):,} | {' | '.join(shares)} |" in MEASURED.splitlines()


def test_first_run_says_what_the_speed_of_a_person_costs() -> None:
    small, large = (CONDITIONS[measure_shares.CONDITIONS[k]]["New field"] for k in (1, 2))
    known = CONDITIONS[measure_shares.CONDITIONS[3]]["New field"]
    words = " ".join(FIRST_RUN.split())
    assert f"walk into the standing robot in {standing(small[1])} % of 1,500" in words
    assert f"in {standing(large[1])} % when they are sized for 1.6 m/s" in words
    assert toward(small[5]) == toward(known[5]) == "0.0"
    assert f"{away(small[5])} % touch the robot while it retreats from them with regions for 1.0 m/s" in words
    assert f"its regions are sized for it: {away(known[5])} %" in words


def test_validation_quotes_its_tables() -> None:
    slow, fast, sized, known = (CONDITIONS[each] for each in measure_shares.CONDITIONS)
    words = " ".join(VALIDATION.split())
    field = [rows["New field"][k] for rows in CONDITIONS.values() for k in (1, 3, 5)]
    assert "toward nobody whom it touches, with any sensing" in words
    assert {toward(cell) for cell in field} == {"0.0"}
    assert f"still retreats, {away(fast['New field'][5])} % with regions for 1.0 m/s" in words
    assert f"know nothing of the sensing {away(sized['New field'][5])} %" in words
    assert f"as well {away(known['New field'][5])} %, where the adversary finds it standing" in words
    assert known["New field"][6] == "stands"
    noisy = [rows["Velocity obstacle"][3] for rows in (fast, slow)]
    assert f"it moves toward {' to '.join(map(toward, noisy))} %" in words
    assert f"from behind by {' to '.join(map(away, noisy))} %" in words
    ends = [away(rows["ORCA"][k]) for rows in (slow, fast) for k in (1, 5)]
    assert "{} to {} % of the people of up to 1.0 m/s and {} to {} % of those".format(*ends) in words


@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.name)
def test_every_person_of_a_guide_has_a_chosen_speed(guide: Path) -> None:
    text = guide.read_text(encoding="utf-8")
    for block in re.findall(r"^```(?:python|toml)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        people = len(re.findall(r"nav\.Human[.(]|type = \"human\"", block))
        assert block.count("max_speed") >= people
