"""What a controller commands before it has been told where its robot is."""

import pytest

from hrsafety import navigation as nav
from hrsafety.navigation import SafeNavigation, Shield

FIELD = nav.VirtualForceField()


@pytest.mark.parametrize("updates", [1, 3])
def test_two_wheels_stand_before_their_first_position(updates: int) -> None:
    controller = nav.Controller(
        SafeNavigation(FIELD, shield=Shield()), nav.DifferentialDriveRobot(), goal=(5.0, 0.0), control_period=0.1
    )
    for step in range(updates):
        command = controller.update(0.1 * step, None, None)
        assert (command.speed, command.turn_rate, command.status) == (0.0, 0.0, "braking")
    command = controller.update(1.0, (0.0, 0.0), (0.0, 0.0), heading=0.0)
    assert command.speed is not None
    assert command.turn_rate is not None


def test_a_start_that_is_told_gives_two_wheels_a_twist_without_a_position() -> None:
    controller = nav.Controller(
        SafeNavigation(FIELD, shield=Shield()),
        nav.DifferentialDriveRobot(),
        goal=(5.0, 0.0),
        start=(0.0, 0.0),
        control_period=0.1,
    )
    command = controller.update(0.0, None, None)
    assert (command.speed, command.turn_rate, command.velocity) == (0.0, 0.0, (0.0, 0.0))


def test_a_holonomic_robot_has_no_twist() -> None:
    controller = nav.Controller(FIELD, nav.HolonomicRobot(), goal=(5.0, 0.0), control_period=0.1)
    command = controller.update(0.0, None, None)
    assert (command.speed, command.turn_rate) == (None, None)
