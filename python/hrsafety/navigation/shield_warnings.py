"""Whether the shield of a run assumes as much as its scene asks for: else its theorem says nothing about the run."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_warnings import own_speed
from hrsafety.plausibility import ResultWarning

__all__ = ["of_shield"]

ASSUMES_LESS = "shield_assumes_less"
SEES_LESS = "shield_sees_less"

# A bound this far below what it has to cover was typed with fewer digits; a share of it.
ROUNDING = 1e-4


def of_shield(scenario: Scenario, shield: Shield, built: AsBuilt | None = None) -> Iterator[ResultWarning]:
    """Warn of bounds that a scene exceeds: people who are faster, positions that are later or less exact.

    Parameters
    ----------
    scenario : Scenario
        Where the robot runs.
    shield : Shield
        What is assumed.
    built : AsBuilt or None
        Sensors of the robot; without them the obstacles are known as the scenario says.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    for name, assumed, least, why in _needed(scenario, shield):
        if assumed < least * (1.0 - ROUNDING):
            yield ResultWarning(
                ASSUMES_LESS,
                f"shield.{name}",
                f"{name} of the shield is {assumed:.4g}, but {why}: it may let the robot move into somebody; give at "
                f"least {name}={least:.4g}",
            )
    if built is not None and (built.obstacle_vision is not None or built.sensors):
        yield ResultWarning(
            SEES_LESS,
            "sensors",
            "the shield keeps off those whom the sensors show at the time, with the errors and the age that it "
            "assumes: who is hidden, or was not seen yet, is not there for it",
        )


def _needed(scenario: Scenario, shield: Shield) -> Iterator[tuple[str, float, float, str]]:
    """Yield name, assumed value, the least one that covers the scene, and what asks for it."""
    if shield.person_speed is not None:
        for index, obstacle in enumerate(scenario.obstacles):
            speed = own_speed(obstacle)
            yield "person_speed", shield.person_speed, speed, f"obstacles[{index}] moves at up to {speed:.4g} m/s"
    measured = scenario.measurement
    if measured is None:
        return
    bound, latency = measured._native.error_bound(), measured.latency
    if measured.of in ("both", "obstacles"):
        yield "latency", shield.latency, latency, f"positions are measured {latency:.4g} s late"
        yield "position_error", shield.position_error, bound, f"positions are wrong by up to {bound:.4g} m"
        if shield.velocity_error is not None:
            # Backward differences of two wrong positions.
            error = 2.0 * bound / scenario.control_period
            why = f"velocities from differences of positions are wrong by up to {error:.4g} m/s"
            yield "velocity_error", shield.velocity_error, error, why
    if measured.of in ("both", "robot"):
        own = bound + latency * scenario.robot.max_speed
        yield "margin", shield.margin, own, f"the robot knows its own place to {own:.4g} m only"
