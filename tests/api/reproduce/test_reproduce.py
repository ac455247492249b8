from __future__ import annotations

import csv
import json
import math
import multiprocessing
import os
import re
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.interrupting import LISTEN, needs_signals
from api.read_pages import page_of
from hrsafety import _atomic as atomic
from hrsafety import reproduce
from hrsafety.errors import InvalidParameterError, MissingExtraError, SimulationError
from hrsafety.navigation import metrics
from hrsafety.reproduce import cells, figures, page, ranking, reasons, study, tables
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain import tables as gain_tables

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[3].parent / "shared"))
NUMBERS = ["5.1", *(f"6.{i}" for i in range(1, 6)), *(f"7.{i}" for i in range(1, 5)), *(f"C.{i}" for i in range(1, 10))]
IMPACT_NUMBERS = ["3.1", "3.2", "3.3", "4.1", "4.2", "A.1"]
SHORT_RUN = "tables-6"
# Deviations are recomputed by the same two operations: equal but for the last bits.
REPEATED = 1e-12
SECONDS_TAKEN = re.compile(rb"Made .*; simulations and pictures took .* s")


@pytest.fixture(scope="module")
def all_cells() -> list[PrintedValue]:
    return [*tables.chapter_6(), *tables.chapter_7(), *tables.unpredictable_human(), *gain_tables.appendix_c()]


@pytest.fixture(scope="module")
def short_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return reproduce.run(tmp_path_factory.mktemp("reproduction"), only=SHORT_RUN)


def printed_numbers() -> Iterator[tuple[str, str, str, float]]:
    published = reproduce.published_tables()
    for number in NUMBERS:
        for row in published[f"zeng2011:{number}"]["rows"]:
            change = row.get("change_percent")
            label = row.get("method") or ("0 %" if change == 0 else f"{change:+g} %")
            for column, value in row.items():
                if isinstance(value, int | float) and column != "change_percent":
                    yield number, label, column, float(value)


def by_place(all_cells: list[PrintedValue]) -> dict[tuple[str, str, str], PrintedValue]:
    return {(cell.table, cell.row, cell.column): cell for cell in all_cells}


# ---- what has to be installed ------------------------------------------------------------------------


def test_missing_scipy_is_told_before_the_work_begins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    said: list[str] = []
    with pytest.raises(MissingExtraError, match=r"pip install scipy"):
        reproduce.run(tmp_path / "out", progress=said.append)
    assert said == []
    assert not (tmp_path / "out").exists()


# ---- the shipped numbers ----------------------------------------------------------------------------


def test_published_tables_are_all_there_with_rows_and_titles() -> None:
    published = reproduce.published_tables()
    for number in NUMBERS:
        assert published[f"zeng2011:{number}"]["rows"], number
        assert published[f"zeng2011:{number}"]["title"], number


def test_published_tables_equal_the_specification() -> None:
    source = SHARED / "spec" / "published_tables.json"
    if not source.is_file():
        pytest.skip(f"needs the specification's tables: {source}")
    original = json.loads(source.read_text(encoding="utf-8"))
    published = reproduce.published_tables()
    for number in [*NUMBERS, *IMPACT_NUMBERS]:
        assert published[f"zeng2011:{number}"] == original[f"zeng2011:{number}"], number


def test_published_tables_cannot_be_changed_by_a_caller() -> None:
    reproduce.published_tables()["zeng2011:6.2"]["rows"][0]["T_arrive"] = 0.0
    assert reproduce.published_tables()["zeng2011:6.2"]["rows"][0]["T_arrive"] == 6.7


# ---- cells ------------------------------------------------------------------------------------------


def test_every_printed_number_has_exactly_one_cell(all_cells: list[PrintedValue]) -> None:
    expected = Counter(printed_numbers())
    found = Counter(
        (cell.table, cell.row, cell.column, cell.printed)
        for cell in all_cells
        if not isinstance(cell.printed, str) and cell.table in NUMBERS
    )
    assert found == expected


def test_every_printed_outcome_has_exactly_one_cell(all_cells: list[PrintedValue]) -> None:
    words = [(cell.table, cell.column) for cell in all_cells if isinstance(cell.printed, str) and cell.table in NUMBERS]
    assert sorted(words) == [(f"C.{number}", f"outcome_{k}") for number in (3, 5, 7, 9) for k in (1, 2, 3)]


def test_deviations_and_verdicts_follow_from_printed_and_measured(all_cells: list[PrintedValue]) -> None:
    judged = [cell for cell in all_cells if isinstance(cell.measured, float) and cell.within is not None]
    assert len(judged) > 700
    for cell in judged:
        assert isinstance(cell.measured, float)
        assert isinstance(cell.printed, float)
        difference = cell.measured - cell.printed
        expected = difference / cell.printed if cell.relative else difference
        assert cell.deviation == pytest.approx(expected, rel=REPEATED, abs=REPEATED)
        assert cell.tolerance is not None
        if abs(abs(expected) - cell.tolerance) > 1e-8:
            assert cell.within is (abs(expected) < cell.tolerance), cell


def test_cells_that_are_off_or_not_measured_say_why(all_cells: list[PrintedValue]) -> None:
    silent = [(cell.table, cell.row, cell.column) for cell in all_cells if not cell.within and not cell.reason]
    assert silent == []


def test_every_documented_cause_explains_some_cell_that_is_off(all_cells: list[PrintedValue]) -> None:
    off = [cell for cell in all_cells if cell.within is False]
    for cause in reasons.CAUSES:
        assert any(cell.reason.startswith(cause.text) for cell in off), cause


def test_cells_that_agree_carry_no_excuse(all_cells: list[PrintedValue]) -> None:
    for cell in all_cells:
        if cell.within and cell.reason:
            assert cell.reason == reasons.note_of(cell.table, cell.row, cell.column)


def test_tables_of_a_single_disc_agree_where_the_specification_says_so(all_cells: list[PrintedValue]) -> None:
    places = by_place(all_cells)
    for table, row in (("6.2", "new_vff"), ("6.4", "new_vff"), ("7.1", "holonomic"), ("7.2", "holonomic")):
        assert places[table, row, "T_arrive"].within, (table, row)
    assert places["7.1", "holonomic", "d_circle_min"].within
    assert places["6.2", "new_vff_optimised", "d_circle_min"].within
    assert not places["6.2", "new_vff", "d_circle_min"].within


def test_exchanged_columns_of_configuration_3_are_compared_with_the_right_obstacle(
    all_cells: list[PrintedValue],
) -> None:
    places = by_place(all_cells)
    for table in ("C.2", "C.4", "C.6", "C.8"):
        rectangle = places["6.4", "new_vff_optimised", "d_rectangle_min"].measured
        disc = places["6.4", "new_vff_optimised", "d_circle_min"].measured
        assert places[table, "0 %", "d_circle_min_3"].measured == rectangle
        assert places[table, "0 %", "d_rectangle_min_3"].measured == disc
        assert reasons.EXCHANGED_COLUMNS in places[table, "0 %", "d_circle_min_3"].reason


def test_sensitivities_follow_from_the_measured_mean_scores(all_cells: list[PrintedValue]) -> None:
    places = by_place(all_cells)
    checked = 0
    for (table, row, column), cell in places.items():
        if column == "sensitivity_percent" and row != "0 %":
            score, optimum = places[table, row, "H_mean"].measured, places[table, "0 %", "H_mean"].measured
            assert isinstance(score, float)
            assert isinstance(optimum, float)
            change = float(row.removesuffix(" %"))
            expected = abs((1 - score / optimum) / (change / 100)) * 100
            assert cell.measured == pytest.approx(expected, rel=REPEATED, abs=REPEATED)
            checked += 1
    assert checked == 44


def test_mean_score_is_the_mean_of_three_configurations(all_cells: list[PrintedValue]) -> None:
    places = by_place(all_cells)
    for table in ("C.3", "C.5", "C.7", "C.9"):
        scores = [places[table, "+50 %", f"H_{k}"].measured for k in (1, 2, 3)]
        assert places[table, "+50 %", "H_mean"].measured == pytest.approx(np.mean(np.array(scores, dtype=float)))


@pytest.mark.parametrize(("measured", "within"), [(1.05, True), (0.95, True), (1.0501, False), (0.9499, False)])
def test_verdict_turns_at_the_tolerance(measured: float, within: bool) -> None:
    cell = PrintedValue.compared(
        table="t", row="r", column="T_arrive", printed=1.0, measured=measured, tolerance=cells.ARRIVAL_TIME, unit="s"
    )
    assert cell.within is within


def test_run_without_arrival_is_never_within() -> None:
    cell = PrintedValue.compared(
        table="t", row="r", column="T", printed=1.0, measured=math.nan, tolerance=cells.ARRIVAL_TIME, unit="s"
    )
    assert cell.within is False
    assert cell.measured == "no arrival"


# ---- the page ---------------------------------------------------------------------------------------


def test_page_is_well_formed_and_needs_no_network(short_run: Path) -> None:
    text = short_run.read_text(encoding="utf-8")
    page = page_of(text)
    assert "http://" not in text
    assert "https://" not in text
    assert "url(" not in text
    assert max(page.ids.values()) == 1
    assert {target.removeprefix("#") for target in page.links} <= set(page.ids)


def test_page_shows_every_cell_with_printed_measured_and_reason(short_run: Path) -> None:
    text = " ".join(page_of(short_run).texts)
    for cell in tables.chapter_6():
        assert f"{cell.printed:g}" in text
        assert cell.reason in text
        if isinstance(cell.measured, float):
            assert f"{cell.measured:.{2 if cell.unit in {'s', 'J'} else 3}f}" in text


def test_page_counts_what_the_values_say(short_run: Path) -> None:
    values = json.loads(short_run.with_name("tables.json").read_text(encoding="utf-8"))
    judged = [value for value in values if value["within"] is not None]
    within = [value for value in judged if value["within"]]
    assert 0 < len(within) < len(judged)
    text = short_run.read_text(encoding="utf-8")
    assert f"{len(within)} of {len(judged)} judged values are within tolerance" in text


def test_page_names_its_command_and_versions(short_run: Path) -> None:
    text = short_run.read_text(encoding="utf-8")
    assert f"hrsafety reproduce --only {SHORT_RUN} --out " in text
    assert f"numpy {np.__version__}" in text


def test_csv_and_json_hold_the_same_values(short_run: Path) -> None:
    values = json.loads(short_run.with_name("tables.json").read_text(encoding="utf-8"))
    with short_run.with_name("tables.csv").open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == len(values) == len(tables.chapter_6())
    for line, value in zip(lines, values, strict=True):
        assert line["reason"] == value["reason"]
        assert float(line["printed"]) == value["printed"]


def test_parts_that_are_not_asked_for_are_not_made(short_run: Path) -> None:
    assert sorted(path.name for path in short_run.parent.iterdir()) == ["summary.html", "tables.csv", "tables.json"]


def test_existing_folder_keeps_the_files_of_others(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    (tmp_path / "summary.html").write_text("old", encoding="utf-8")
    reproduce.run(tmp_path, only=["table-5.1"])
    assert (tmp_path / "notes.txt").read_text(encoding="utf-8") == "mine"
    assert (tmp_path / "summary.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_progress_names_each_part(tmp_path: Path) -> None:
    lines: list[str] = []
    reproduce.run(tmp_path, only=["table-5.1", "tables-7"], progress=lines.append)
    assert [line.split(":")[0] for line in lines] == ["tables-7", "table-5.1", "writing the page"]


def test_processes_write_the_same_values_and_pictures(tmp_path: Path) -> None:
    only = ["tables-6", "table-5.1", "wheels"]
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        reproduce.run(tmp_path / "pool", only=only, executor=pool)
    reproduce.run(tmp_path / "here", only=only)
    files = [file.relative_to(tmp_path / "here") for file in sorted((tmp_path / "here").rglob("*.*"))]
    assert len(files) == 7
    for file in files:
        there, here = ((tmp_path / folder / file).read_bytes() for folder in ("pool", "here"))
        if file.name == "summary.html":
            there, here = (SECONDS_TAKEN.sub(b"", page.replace(b"pool", b"here")) for page in (there, here))
        assert there == here, file


# ---- errors and interruptions -----------------------------------------------------------------------


@pytest.mark.parametrize("only", ["tables-9", ["tables-6", "tables-9"]])
def test_unknown_part_is_named_with_the_choice(tmp_path: Path, only: Any) -> None:
    with pytest.raises(InvalidParameterError, match=r"only must be among tables-6, .*stabilizing, .*got 'tables-9'"):
        reproduce.run(tmp_path / "out", only=only)
    assert not (tmp_path / "out").exists()


def test_no_part_at_all_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match="only must be among"):
        reproduce.run(tmp_path, only=[])


def test_file_in_place_of_the_folder_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file", encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="out must be a folder or not exist"):
        reproduce.run(tmp_path / "out", only=SHORT_RUN)


def test_a_process_that_ends_is_an_error(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    with (
        ProcessPoolExecutor(1, mp_context=context, initializer=os._exit, initargs=(7,)) as pool,
        pytest.raises(SimulationError, match=r"the pool broke .*nothing was written"),
    ):
        reproduce.run(tmp_path / "out", only=["table-5.1"], executor=pool)
    assert list((tmp_path / "out").iterdir()) == []


@needs_signals
def test_ctrl_c_ends_all_processes(tmp_path: Path) -> None:
    program = LISTEN + "if __name__ == '__main__':\n    from hrsafety.cli import main\n    raise SystemExit(main())\n"
    script = tmp_path / "command.py"
    script.write_text(program, encoding="utf-8")
    words = ("reproduce", "--only", "reactive", "--only", "stabilizing", "--out", str(tmp_path / "out"))
    process = subprocess.Popen([sys.executable, script, *words], stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    assert process.stderr.readline() != ""
    process.send_signal(signal.SIGINT)
    # Whoever is left holds the other end for as long as sounds are measured and followed.
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "Traceback" not in said
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("error", [OSError("disk full"), KeyboardInterrupt()])
def test_interrupted_write_leaves_the_old_file_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    target = atomic.write_file(tmp_path / "values.csv", "old")

    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(type(error)):
        atomic.write_file(target, "new")
    assert [path.name for path in tmp_path.iterdir()] == ["values.csv"]
    assert target.read_text(encoding="utf-8") == "old"


def test_page_is_written_last_so_that_it_exists_only_if_all_else_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(page, "html", fail)
    with pytest.raises(KeyboardInterrupt):
        reproduce.run(tmp_path, only="table-5.1")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["tables.csv", "tables.json"]


# ---- statistics and the comparison of modes ---------------------------------------------------------


@pytest.mark.parametrize(("count", "runs"), [(0, 200), (3, 200), (100, 200), (200, 200), (1, 1)])
def test_wilson_interval_equals_scipy(count: int, runs: int) -> None:
    from scipy.stats import binomtest

    oracle = binomtest(count, runs).proportion_ci(0.95, method="wilson")
    share = metrics.wilson(count, runs)
    assert (share.low, share.high) == pytest.approx((oracle.low, oracle.high), rel=1e-9, abs=1e-12)
    assert share.low <= share.value <= share.high


@pytest.mark.parametrize(("only_first", "only_second"), [(0, 0), (5, 0), (12, 7), (40, 41), (900, 1100)])
def test_paired_test_equals_scipy(only_first: int, only_second: int) -> None:
    from scipy.stats import binomtest

    first = np.array([True] * only_first + [False] * only_second + [True, False])
    second = np.array([False] * only_first + [True] * only_second + [True, False])
    paired = metrics.compare_paired(first, second)
    assert (paired.only_first, paired.only_second) == (only_first, only_second)
    differing = only_first + only_second
    expected = 1.0 if differing == 0 else binomtest(only_first, differing).pvalue
    assert paired.p_value == pytest.approx(expected, rel=1e-9)


def outcomes(*, contacts: int, arrivals: int = 400, score: float = 0.5, runs: int = 400) -> ranking.Outcomes:
    index = np.arange(runs)
    return ranking.Outcomes(
        outcome=np.where(index < contacts, "collided", "arrived"),
        moving=index < contacts,
        standing=np.zeros(runs, dtype=bool),
        arrived=index >= runs - arrivals,
        time=np.full(runs, 7.0),
        score=np.full(runs, score),
        clearance=np.full(runs, 0.3),
        descent=np.full(runs, 0.9),
        distance=np.full((runs, 1), 0.9),
    )


def ranked(*experiments: dict[str, ranking.Outcomes]) -> ranking.Ranking:
    return ranking.rank({f"experiment {k}": modes for k, modes in enumerate(experiments)}, gains="any", side="any")


def test_fewer_contacts_beat_more_arrivals_and_a_higher_score() -> None:
    fast = outcomes(contacts=50, arrivals=400, score=0.9)
    safe = outcomes(contacts=5, arrivals=300, score=0.4)
    assert ranked({"off": fast, "a": safe, "b": fast}).recommended == "a"


def test_difference_in_contacts_that_chance_explains_leaves_the_choice_to_the_score() -> None:
    assert ranked({"off": outcomes(contacts=5), "a": outcomes(contacts=7, score=0.6)}).recommended == "a"


def test_more_arrivals_beat_a_higher_score() -> None:
    lingering = outcomes(contacts=5, arrivals=350, score=0.8)
    assert ranked({"off": lingering, "a": outcomes(contacts=5, arrivals=400, score=0.4)}).recommended == "a"


def test_mode_that_harms_in_one_experiment_is_out_even_if_it_is_best_over_all() -> None:
    harmed = {"off": outcomes(contacts=10), "a": outcomes(contacts=60), "b": outcomes(contacts=11)}
    helped = {"off": outcomes(contacts=300), "a": outcomes(contacts=0), "b": outcomes(contacts=250)}
    result = ranked(harmed, helped)
    assert result.pooled_only == "a"
    assert result.recommended == "b"
    assert "a in experiment 0 (60 against 10)" in result.steps[0]


@pytest.fixture(scope="module")
def small_study() -> study.LawComparisons:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "NOISE_SEEDS", 3)
        patch.setattr(study, "CROWD_SEEDS", 4)
        return study.compare()


def test_study_has_every_experiment_side_gain_set_and_mode_once(small_study: study.LawComparisons) -> None:
    keys = Counter(entry.key for entry in small_study.aggregates)
    assert set(keys.values()) == {1}
    assert set(keys) == set(small_study.runs)
    experiments = {key.experiment for key in keys}
    assert len(keys) == len(experiments) * len(study.SIDES) * 2 * len(study.MODES)
    assert {"c1", "c2", "c3", "c4", "crowds of 3", "crowds of 12"} <= experiments
    assert small_study.recommended in study.MODES


def test_noise_and_crowds_have_the_runs_that_were_asked_for(small_study: study.LawComparisons) -> None:
    for key, runs in small_study.runs.items():
        expected = 4 if key.experiment.startswith("crowds") else 3 if "noise" in key.experiment else 1
        assert len(runs.outcome) == expected


def test_ranking_leaves_out_single_runs_and_the_mild_noise(small_study: study.LawComparisons) -> None:
    ranked_runs = 6 * 3 + 2 * 4
    assert f"Runs with a contact, of {2 * ranked_runs}:" in small_study.rankings[0].steps[1]
    assert f"Runs with a contact, of {ranked_runs}:" in small_study.rankings[1].steps[1]


def test_off_differs_from_itself_in_no_run(small_study: study.LawComparisons) -> None:
    own = [entry.against_off for entry in small_study.aggregates if entry.key.mode == "off"]
    assert own
    assert set(own) == {metrics.Paired(0, 0, 1.0)}


def test_single_runs_of_the_study_are_those_of_the_tables(
    small_study: study.LawComparisons, all_cells: list[PrintedValue]
) -> None:
    places = by_place(all_cells)
    compared = 0
    for entry in small_study.aggregates:
        key = entry.key
        if key.mode == "off" and key.side == "decided afresh" and entry.arrivals.runs == 1:
            table = f"6.{int(key.experiment[1]) + 1}"
            assert entry.median_arrival_time == places[table, key.gains, "T_arrive"].measured
            assert entry.mean_score == places[table, key.gains, "H"].measured
            compared += 1
    assert compared == 8


def test_study_part_of_the_page_is_well_formed(
    small_study: study.LawComparisons, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "compare", lambda _: small_study)
    text = reproduce.run(tmp_path, only="stabilizing").read_text(encoding="utf-8")
    assert small_study.recommended in " ".join(page_of(text).texts)
    written = json.loads((tmp_path / "stabilizing.json").read_text(encoding="utf-8"))
    assert written["recommended"] == small_study.recommended
    assert len(written["aggregates"]) == len(small_study.aggregates)


# ---- pictures ---------------------------------------------------------------------------------------


def test_pictures_have_names_of_their_own_and_captions_that_are_sentences() -> None:
    drawings = list(figures._pictures())
    assert len({name for name, _, _ in drawings}) == len(drawings) > 20
    assert all(caption.endswith(".") and caption[0].isupper() for _, caption, _ in drawings)


def test_pictures_are_embedded_and_lie_beside_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = list(figures._pictures())[:1]
    monkeypatch.setattr(figures, "_pictures", lambda: chosen)
    text = reproduce.run(tmp_path, only="figures-6").read_text(encoding="utf-8")
    (file,) = (tmp_path / "figures").iterdir()
    assert file.name == f"{chosen[0][0]}.png"
    assert file.read_bytes().startswith(b"\x89PNG\r\n")
    page_of(text)
    assert text.count("data:image/png;base64,") == 1
