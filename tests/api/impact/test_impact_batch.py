"""Many impacts in one call: shapes, rows that cannot be, agreement with single calls, progress."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, impact

MANIPULATOR, FOAM, HEAD = impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum()
PARTS: dict[str, Any] = {"manipulator": MANIPULATOR, "foam": FOAM, "head": HEAD}
NUMBERS = [name for name in impact.ImpactMetrics._fields if name not in ("status", "beyond_linear_range")]
PEAKS = [
    "peak_head_acceleration",
    "peak_head_acceleration_g",
    "peak_contact_force",
    "max_compression",
    "impact_duration",
]

# Lanes and single calls may order the same sums differently; each is good to 1e-11 of its scale.
AGREEMENT = 1e-9


def assert_row(batch: impact.ImpactMetricsBatch, index: Any, single: impact.ImpactMetrics) -> None:
    for name in NUMBERS:
        found, wanted = getattr(batch, name)[index], getattr(single, name)
        assert found == pytest.approx(wanted, rel=AGREEMENT, nan_ok=True), name
    assert batch.status[index] == single.status
    assert batch.beyond_linear_range[index] == single.beyond_linear_range


# ---- shapes ---------------------------------------------------------------------------------


def test_plain_numbers_give_arrays_without_axes() -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=1.25)
    assert found.shape == ()
    assert_row(found, (), impact.metrics(MANIPULATOR, FOAM, HEAD, closing_speed=1.25))


@pytest.mark.parametrize("shape", [(1,), (1, 1), (3,), (2, 3), (0,), (0, 4)])
def test_result_has_the_shape_of_the_array(shape: tuple[int, ...]) -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=np.full(shape, 1.25))
    assert found.shape == shape
    assert found.status.shape == shape
    assert all(getattr(found, name).shape == shape for name in NUMBERS)
    assert len(found) == shape[0]


def test_arrays_broadcast_against_each_other() -> None:
    stiffness, damping = np.array([[10e3], [20e3], [30e3]]), np.array([0.0, 50.0])
    found = impact.metrics_batch(**PARTS, closing_speed=1.25, foam_stiffness=stiffness, foam_damping=damping)
    assert found.shape == (3, 2)
    for i, j in np.ndindex(3, 2):
        foam = impact.Foam(stiffness=stiffness[i, 0], damping=damping[j])
        assert_row(found, (i, j), impact.metrics(MANIPULATOR, foam, HEAD, closing_speed=1.25))


def test_strided_and_integer_arrays_are_read_as_they_stand() -> None:
    speeds = np.arange(1, 9)[::-2]
    found = impact.metrics_batch(**PARTS, closing_speed=speeds)
    plain = impact.metrics_batch(**PARTS, closing_speed=[8.0, 6.0, 4.0, 2.0])
    assert found.peak_contact_force.tolist() == plain.peak_contact_force.tolist()


def test_every_number_can_be_an_array() -> None:
    source = np.random.default_rng(7)
    columns = {
        "manipulator_mass": source.uniform(5.0, 60.0, 40),
        "manipulator_damping": source.uniform(0.0, 400.0, 40),
        "manipulator_stiffness": source.uniform(1e3, 40e3, 40),
        "foam_stiffness": source.uniform(2e3, 80e3, 40),
        "foam_damping": source.uniform(0.0, 200.0, 40),
        "linear_range": source.uniform(0.005, 0.0254, 40),
        "head_mass": source.uniform(3.0, 6.0, 40),
        "head_damping": source.uniform(0.0, 150.0, 40),
        "head_stiffness": source.uniform(1e3, 6e3, 40),
        "closing_speed": source.uniform(0.1, 3.0, 40),
        "manipulator_speed": source.uniform(-1.0, 2.0, 40),
    }
    found = impact.metrics_batch(**columns)
    for row in range(40):
        value = {name: column[row] for name, column in columns.items()}

        def part(kind: Any, owner: str, value: dict[str, Any] = value) -> Any:
            return kind(**{name: value[f"{owner}_{name}"] for name in ("mass", "damping", "stiffness")})

        foam = impact.Foam(
            stiffness=value["foam_stiffness"], damping=value["foam_damping"], linear_range=value["linear_range"]
        )
        single = impact.metrics(
            part(impact.Manipulator, "manipulator"),
            foam,
            part(impact.Head, "head"),
            closing_speed=value["closing_speed"],
            manipulator_speed=value["manipulator_speed"],
        )
        assert_row(found, row, single)


def test_separate_number_wins_over_the_parameter_object() -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=1.25, head_mass=5.3)
    head = impact.Head(mass=5.3, damping=HEAD.damping, stiffness=HEAD.stiffness)
    assert_row(found, (), impact.metrics(MANIPULATOR, FOAM, head, closing_speed=1.25))


def test_arrays_that_do_not_broadcast_are_refused_by_name() -> None:
    with pytest.raises(ShapeError) as caught:
        impact.metrics_batch(**PARTS, closing_speed=[1.0, 2.0], foam_stiffness=[1e3, 2e3, 3e3])
    assert caught.value.argument in {"closing_speed", "foam_stiffness"}


@pytest.mark.parametrize("missing", ["manipulator", "foam", "head"])
def test_a_number_without_source_is_refused_by_name(missing: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        impact.metrics_batch(**{**PARTS, missing: None}, closing_speed=1.25)
    assert caught.value.argument.startswith(f"{missing}_")
    assert missing in caught.value.requirement


# ---- rows -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("argument", "bad"),
    [
        ("manipulator_mass", [0.0, -1.0, np.nan, np.inf]),
        ("manipulator_damping", [-1.0, np.nan, np.inf]),
        ("manipulator_stiffness", [-1.0, np.nan, -np.inf]),
        ("foam_stiffness", [-1.0, np.nan]),
        ("foam_damping", [-1e-9, np.nan]),
        ("linear_range", [0.0, -1.0, np.nan]),
        ("head_mass", [0.0, -1.0, np.nan]),
        ("head_damping", [-1.0, np.nan]),
        ("head_stiffness", [-1.0, np.nan]),
        ("closing_speed", [np.nan, np.inf, -np.inf]),
        ("manipulator_speed", [np.nan, np.inf]),
    ],
)
@pytest.mark.parametrize("fields", ["all", "peaks"])
def test_bad_row_is_nan_with_a_status_and_the_others_stand(argument: str, bad: list[float], fields: Any) -> None:
    right = {"linear_range": 0.02, "closing_speed": 1.25, "manipulator_speed": 1.25}
    for owner, part in PARTS.items():
        right |= {
            f"{owner}_{name}": getattr(part, name) for name in ("mass", "damping", "stiffness") if hasattr(part, name)
        }
    column = np.array([right[argument], *bad, right[argument]])
    found = impact.metrics_batch(**{**PARTS, "closing_speed": 1.25, argument: column}, fields=fields)
    for name in NUMBERS:
        assert np.isnan(getattr(found, name)[1:-1]).all(), name
    assert set(found.status[1:-1].tolist()) == {f"invalid_{argument}"}
    whole = impact.metrics(MANIPULATOR, FOAM, HEAD, closing_speed=1.25)
    for row in (0, -1):
        assert found.status[row] == "released"
        for name in PEAKS:
            assert getattr(found, name)[row] == pytest.approx(getattr(whole, name), rel=AGREEMENT)


def test_bodies_that_do_not_close_in_are_no_impact() -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=[0.0, -1.0, 1.0])
    assert found.status.tolist() == ["no_impact", "no_impact", "released"]
    assert np.isnan(found.peak_contact_force[:2]).all()
    assert impact.metrics(MANIPULATOR, FOAM, HEAD, closing_speed=-1.0).status == "no_impact"


def test_compression_beyond_the_linear_range_is_flagged() -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=1.25, linear_range=[0.02, 0.01])
    assert found.status.tolist() == ["released", "beyond_linear_range"]
    assert found.beyond_linear_range.tolist() == [False, True]
    assert found.max_compression[0] == found.max_compression[1]


def test_impact_that_lasts_is_flagged() -> None:
    short = {"horizon": 0.01}
    found = impact.metrics_batch(**PARTS, closing_speed=[1.25], **short)
    single = impact.metrics(MANIPULATOR, FOAM, HEAD, closing_speed=1.25, **short)
    assert_row(found, 0, single)
    assert single.status == "no_release"
    assert single.impact_duration == np.inf


def test_constrained_head_has_no_head_fields() -> None:
    parts = {**PARTS, "head": impact.ConstrainedHead()}
    found = impact.metrics_batch(**parts, closing_speed=[0.25, 0.5])
    single = impact.metrics(MANIPULATOR, FOAM, parts["head"], closing_speed=0.25)
    assert_row(found, 0, single)
    assert set(found.status.tolist()) == {"constrained"}
    absent = [name for name in NUMBERS if np.isnan(getattr(found, name)).all()]
    kept = {"peak_contact_force", "max_compression", "peak_power_manipulator", "peak_power_foam"}
    assert set(absent) == set(NUMBERS) - kept
    with pytest.raises(InvalidParameterError) as caught:
        impact.metrics_batch(**parts, closing_speed=0.25, head_mass=4.4)
    assert caught.value.argument == "head_mass"


# ---- options --------------------------------------------------------------------------------


def many(**options: Any) -> impact.ImpactMetricsBatch:
    source = np.random.default_rng(11)
    return impact.metrics_batch(
        **PARTS,
        closing_speed=source.uniform(0.1, 2.0, 300),
        foam_stiffness=source.uniform(5e3, 70e3, 300),
        foam_damping=source.uniform(0.0, 150.0, 300),
        **options,
    )


@pytest.mark.parametrize(
    "options", [{"threads": 1}, {"threads": 3}, {"lanes": 1}, {"lanes": 4}, {"lanes": 8}, {"lanes": 16}]
)
def test_threads_and_lanes_change_nothing_that_counts(options: dict[str, int]) -> None:
    plain, other = many(), many(**options)
    assert other.status.tolist() == plain.status.tolist()
    for name in NUMBERS:
        if "threads" in options:
            assert getattr(other, name).tobytes() == getattr(plain, name).tobytes(), name
        else:
            assert getattr(other, name) == pytest.approx(getattr(plain, name), rel=AGREEMENT, nan_ok=True), name


def test_peaks_only_leaves_the_other_fields_nan() -> None:
    plain, peaks = many(), many(fields="peaks")
    for name in NUMBERS:
        if name in PEAKS:
            assert getattr(peaks, name) == pytest.approx(getattr(plain, name), rel=AGREEMENT), name
        else:
            assert np.isnan(getattr(peaks, name)).all(), name
    assert peaks.status.tolist() == plain.status.tolist()


@pytest.mark.parametrize(
    "outputs", [*([name] for name in NUMBERS), ["clip_3ms_g", "hic36"], ["peak_power_foam", "max_compression"], []]
)
def test_only_the_criteria_asked_for_are_computed(outputs: list[str]) -> None:
    plain, few = many(), many(outputs=outputs)
    for name in NUMBERS:
        if name in outputs:
            assert getattr(few, name) == pytest.approx(getattr(plain, name), rel=AGREEMENT, nan_ok=True), name
        else:
            assert np.isnan(getattr(few, name)).all(), name
            assert getattr(few, name).strides == (0,), name  # one number stands for all rows
    assert few.status.tolist() == plain.status.tolist()
    assert few.beyond_linear_range.tolist() == plain.beyond_linear_range.tolist()


def test_every_criterion_alone_agrees_where_the_head_cannot_move() -> None:
    fixed = {**PARTS, "head": impact.ConstrainedHead()}
    speeds = np.linspace(0.1, 2.0, 7)
    plain = impact.metrics_batch(**fixed, closing_speed=speeds)
    for name in NUMBERS:
        few = impact.metrics_batch(**fixed, closing_speed=speeds, outputs=[name])
        np.testing.assert_array_equal(getattr(few, name), getattr(plain, name))


def test_unknown_outputs_are_refused_with_the_nearest_name() -> None:
    with pytest.raises(InvalidParameterError, match=r"outputs\[1\].*hic36"):
        many(outputs=["hic15", "hic63"])
    with pytest.raises(InvalidParameterError, match=r"outputs\[0\]"):
        many(outputs=["hic15"], fields="peaks")
    with pytest.raises(InvalidParameterError, match="outputs"):
        many(outputs="hic15")


def test_columns_are_flat_and_complete() -> None:
    found = impact.metrics_batch(**PARTS, closing_speed=[[0.4, 1.25], [1.0, -1.0]])
    table = found.columns()
    assert list(table) == [*NUMBERS, "beyond_linear_range", "status"]
    assert {values.shape for values in table.values()} == {(4,)}
    assert table["status"].tolist() == ["released", "released", "released", "no_impact"]


def test_huge_and_tiny_numbers_never_fail_the_batch() -> None:
    extreme = np.array([1e-300, 1e-12, 1.0, 1e12, 1e300])
    names = ["manipulator_mass", "foam_stiffness", "foam_damping", "head_mass", "head_stiffness", "closing_speed"]
    for name in names:
        found = impact.metrics_batch(**{**PARTS, "closing_speed": 1.25, name: extreme})
        assert set(found.status.tolist()) <= {
            "released",
            "no_release",
            "beyond_linear_range",
            "bottomed",
            "too_stiff",
        }, name


def test_first_bad_number_gives_the_status() -> None:
    found = impact.metrics_batch(
        **{**PARTS, "closing_speed": [np.nan, 1.25, -1.0]},
        head_mass=[-1.0, -1.0, 4.4],
        manipulator_mass=[0.0, 9.6, 9.6],
        foam_damping=[1.0, 2.0, np.inf],
    )
    assert found.status.tolist() == ["invalid_manipulator_mass", "invalid_head_mass", "invalid_foam_damping"]


def test_bad_number_against_a_wall_is_named_too() -> None:
    found = impact.metrics_batch(
        **{**PARTS, "head": impact.ConstrainedHead()}, closing_speed=[1.0, np.inf], manipulator_stiffness=[-1.0, 20e3]
    )
    assert found.status.tolist() == ["invalid_manipulator_stiffness", "invalid_closing_speed"]


# ---- progress -------------------------------------------------------------------------------


def test_progress_is_told_and_ends_with_the_total() -> None:
    heard: list[tuple[int, int]] = []
    impact.metrics_batch(
        **PARTS,
        closing_speed=np.linspace(0.1, 2.0, 300_000),
        threads=1,
        progress=lambda done, total: heard.append((done, total)),
    )
    done = [each for each, _ in heard]
    assert done == sorted(set(done))
    assert heard[-1] == (300_000, 300_000)
    assert {total for _, total in heard} == {300_000}


def test_progress_that_raises_ends_the_batch() -> None:
    def stop(done: int, total: int) -> None:
        raise ValueError(f"{done} of {total}")

    with pytest.raises(ValueError, match="of 300"):
        impact.metrics_batch(**PARTS, closing_speed=np.linspace(0.1, 2.0, 300), progress=stop)


def test_progress_that_cannot_be_called_is_refused() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        impact.metrics_batch(**PARTS, closing_speed=1.25, progress=3)  # type: ignore[arg-type]  # the point
    assert caught.value.argument == "progress"
