"""``hrsafety record``: repetitions, limits, doubts and exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from hrsafety import contact, standards
from hrsafety.cli import main


def written(folder: Path, peak: float, name: str, *, rest: float = 60.0) -> str:
    time = np.arange(0.0, 1.6, 5e-4)
    force = np.where((time >= 0.2) & (time <= 0.26), peak * np.sin(np.pi * (time - 0.2) / 0.06), 0.0)
    force += np.where(time > 0.23, rest * np.minimum(1.0, (time - 0.23) / 0.05), 0.0)
    rows = "\n".join(f"{1e3 * t:.1f};{f:.2f}".replace(".", ",") for t, f in zip(time, force, strict=True))
    place = folder / name
    place.write_text(f"Device;A 7\nTime;Force\nms;N\n{rows}\n", encoding="utf-8")
    return str(place)


LIMITS = ["--kind", "force", "--transient", "280", "--quasi-static", "140"]
DEVICE = ["--uncertainty", "3"]


def test_three_records_within_their_uncertainty_keep_a_limit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [written(tmp_path, peak, f"hand_{peak:.0f}.csv") for peak in (110.0, 112.0, 111.0)]
    out, told = tmp_path / "out", tmp_path / "told.json"
    assert main(["record", *files, *LIMITS, *DEVICE, "--out", str(out), "--json", str(told)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "passed  within limits"
    found = json.loads(told.read_text(encoding="utf-8"))
    assert found["verdict"] == "within_limits"
    assert [each["contacts"][0]["ends"] for each in found["records"]] == ["clamped"] * 3
    assert {path.name for path in out.iterdir()} == {"summary.html", "traces.png"}


def test_what_is_not_known_keeps_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [written(tmp_path, peak, f"hand_{peak:.0f}.csv") for peak in (110.0, 112.0, 111.0)]
    # No limit; one limit of two; two records; a device that may be 20 N wrong.
    assert main(["record", *files, "--kind", "force"]) == 5
    assert main(["record", *files, "--kind", "force", "--transient", "280"]) == 5
    assert main(["record", *files[:2], *LIMITS]) == 5
    capsys.readouterr()
    assert main(["record", *files, *LIMITS, "--uncertainty", "20"]) == 5
    assert "taken as 0" not in capsys.readouterr().err
    # A device whose uncertainty nobody knows; one that is exact.
    assert main(["record", *files, *LIMITS]) == 5
    assert "no uncertainty of the device is given and it is taken as 0" in capsys.readouterr().err
    assert main(["record", *files, *LIMITS, "--uncertainty", "0"]) == 0
    assert main(["record", *files, *LIMITS, "--free", "--uncertainty", "20"]) == 0
    assert main(["record", *files, written(tmp_path, 300.0, "hard.csv"), *LIMITS]) == 3
    assert "exceeds" in capsys.readouterr().out


def test_wrong_options_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(tmp_path, 110.0, "hand.csv")
    for more, said in (
        (["--kind", "force", "--hic15", "700"], "--hic15"),
        (["--kind", "head", "--hic15", "700"], "unit of acceleration"),
        (["--kind", "pressure", "--pressure", "1e6", "--columns", "Force"], "--pitch"),
    ):
        assert main(["record", file, *more]) == 2
        assert said in capsys.readouterr().err


def test_a_prediction_stands_beside_the_records(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    time = np.arange(0.0, 0.8, 1e-3)
    names = []
    for index, size in enumerate((100.0, 104.0, 98.0)):
        pulse = np.where((time >= 0.1) & (time <= 0.15), size * np.sin(np.pi * (time - 0.1) / 0.05), 0.0)
        rows = "\n".join(f"{each:.4f};{value:.6f}" for each, value in zip(time, pulse, strict=True))
        names.append(f"{index}.csv")
        Path(names[-1]).write_text("t [s];force [N]\n" + rows)
    Path("cell.toml").write_text(
        'speed = 0.05\n[robot]\nmass = 8.0\n[[contacts]]\nregion = "chest"\n'
        "[drive]\nreaction_time = 0.01\ndeceleration = 8.0\n"
    )
    command = ["record", *names, *LIMITS, *DEVICE, "--out", "out", "--json", "out.json"]
    assert main([*command, "--predict", "cell.toml"]) != 0
    assert main([*command, "--predict", "cell.toml", "--plan-row", "1"]) == 0
    found = json.loads(Path("out.json").read_text())["prediction"]
    hit = contact.Contact(robot=8.0, body=standards.limits().contact("chest", "quasi_static"))
    drive = contact.Drive(reaction_time=0.01, deceleration=8.0)
    assert found["prediction"] == pytest.approx(contact.driven_loads(hit, 0.05, drive).force)
    assert found["accept"] == "accept"
    assert found["measured"] == pytest.approx([100.0, 104.0, 98.0], abs=0.2)
    assert "accept" in Path("out/plan.csv").read_text()
    # The load is within its limit, and above what the model of the cell makes of it.
    assert max(found["measured"]) - found["expanded_uncertainty"] > found["prediction"]
    assert "is above the predicted" in Path("out/summary.html").read_text()
    assert (
        "never tuned" in Path("out/summary.html").read_text()
        or "nothing was tuned" in Path("out/summary.html").read_text()
    )
    assert main([*command, "--plan-row", "1"]) != 0
    # The limit of the row counts where none is given; the contact is that of the row.
    without = ["record", *names, *DEVICE, "--kind", "force", "--json", "row.json"]
    without += ["--predict", "cell.toml", "--plan-row", "1"]
    assert main(without) == 0
    row = json.loads(Path("row.json").read_text())
    assert row["limits"] == {"transient": 140.0, "quasi_static": 140.0}
    assert row["verdict"] == "within_limits"
    assert main([*without, "--free"]) != 0
    assert main([*without, "--transient", "90", "--quasi-static", "90"]) == 3


def test_the_same_records_give_the_same_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    time = np.arange(0.0, 0.8, 1e-3)
    pulse = np.where((time >= 0.1) & (time <= 0.15), 90.0 * np.sin(np.pi * (time - 0.1) / 0.05), 0.0)
    rows = [f"{each:.4f};{value:.6f}" for each, value in zip(time, pulse, strict=True)]
    Path("a.csv").write_text("\n".join(["t [s];force [N]", *rows]))
    found = []
    for _ in range(2):
        assert main(["record", "a.csv", *LIMITS, "--out", "out"]) in (0, 5)
        found.append({path.name: path.read_bytes() for path in Path("out").iterdir()})
    assert found[0] == found[1]
    assert b"made 20" not in found[0]["summary.html"]
