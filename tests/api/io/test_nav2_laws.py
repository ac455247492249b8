"""Controllers of Nav2 as laws, and their files written back."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrsafety import InvalidParameterError, io
from hrsafety import navigation as nav
from hrsafety.errors import FileError

TEXT = """\
# by hand
controller_server:
  ros__parameters:
    controller_frequency: 10.0  # Hz
    min_x_velocity_threshold: 0.001
    controller_plugins: ["FollowPath", "Slow", "Samples"]
    FollowPath:
      plugin: "dwb_core::DWBLocalPlanner"
      max_vel_x: 0.3   # carefully
      vx_samples: 12
      critics: ["RotateToGoal", "BaseObstacle", "PathAlign", "PathDist"]
      BaseObstacle.scale: 0.05
      PathAlign.forward_point_distance: 0.2
      RotateToGoal.scale: 32.0
    Slow:
      plugin: "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"
      desired_linear_vel: 0.4
      use_rotate_to_heading: false
      transform_tolerance: 0.1
    Samples:
      plugin: "nav2_mppi_controller::MPPIController"
      vx_max: 0.6
      motion_model: "DiffDrive"
      critics: ["CostCritic", "GoalCritic", "PathAlignCritic"]
      CostCritic: {enabled: true, cost_power: 1, cost_weight: 3.5}
      GoalCritic: {enabled: false}
local_costmap:
  local_costmap:
    ros__parameters:
      robot_radius: 0.22
      update_frequency: 5.0
      inflation_layer: {cost_scaling_factor: 2.5, inflation_radius: 0.6}
collision_monitor:
  ros__parameters:
    FootprintApproach: {type: polygon, action_type: approach, time_before_collision: 1.5, simulation_time_step: 0.1}
"""
ABOVE = "controller_server.ros__parameters"


def settings(folder: Path, text: str) -> io.Nav2Settings:
    path = folder / "nav2.yaml"
    path.write_text(text, encoding="utf-8")
    return io.read_nav2(path)


def test_controllers_are_laws_by_their_names(tmp_path: Path) -> None:
    found = settings(tmp_path, TEXT)
    inflation = {"cost_scaling_factor": 2.5, "inflation_radius": 0.6}
    assert found.laws == {
        "FollowPath": nav.DWB(
            max_vel_x=0.3,
            vx_samples=12,
            obstacle_scale=0.05,
            forward_point_distance=0.2,
            goal_dist_scale=0.0,  # critics that are off
            goal_align_scale=0.0,
            **inflation,  # type: ignore[arg-type]  # numbers
        ),
        "Slow": nav.RegulatedPurePursuit(desired_linear_vel=0.4, use_rotate_to_heading=False, inflation_radius=0.6),
        "Samples": nav.PathIntegral(
            vx_max=0.6,
            cost_weight=3.5,
            goal_weight=0.0,
            path_follow_weight=0.0,
            path_angle_weight=0.0,
            prefer_forward_weight=0.0,
            batch_size=1000,
            time_steps=56,
            model_dt=0.05,
            **inflation,  # type: ignore[arg-type]
        ),
    }
    assert found.period == 0.1
    assert found.monitor == {"FootprintApproach": {"time_before_collision": 1.5, "simulation_time_step": 0.1}}


def test_a_cap_that_the_file_does_not_give_is_told(tmp_path: Path) -> None:
    (doubt,) = (each for each in settings(tmp_path, TEXT).warnings if each.subject == "max_speed_xy")
    assert doubt.message == "no max_speed_xy for FollowPath: 0.26 m/s is taken, less than max_vel_x, 0.3 m/s"
    given = TEXT.replace("max_vel_x:", "max_speed_xy: 0.3\n      max_vel_x:")
    assert "max_speed_xy" not in [each.subject for each in settings(tmp_path, given).warnings]


def test_every_key_is_used_or_listed(tmp_path: Path) -> None:
    found = settings(tmp_path, TEXT)
    assert found.ignored == (
        f"{ABOVE}.FollowPath.critics.RotateToGoal",
        f"{ABOVE}.min_x_velocity_threshold",
        f"{ABOVE}.FollowPath.RotateToGoal.scale",
        f"{ABOVE}.Slow.transform_tolerance",
        "local_costmap.local_costmap.ros__parameters.update_frequency",
        "collision_monitor.ros__parameters.FootprintApproach.type",
    )


def test_a_robot_that_drives_sideways_draws_to_the_side(tmp_path: Path) -> None:
    sideways = settings(tmp_path, TEXT.replace('"DiffDrive"', '"Omni"')).laws["Samples"]
    assert isinstance(sideways, nav.PathIntegral)
    assert sideways.vy_max == 0.5


def test_what_is_written_back_keeps_comments(tmp_path: Path) -> None:
    found = settings(tmp_path, TEXT)
    path = tmp_path / "tuned.yaml"
    found.write(path)
    assert path.read_text(encoding="utf-8") == TEXT
    laws = {
        "FollowPath": found.laws["FollowPath"].replaced(max_vel_x=0.5, sim_time=2.0),
        "Samples": found.laws["Samples"].replaced(cost_weight=4.0, path_align_weight=11.0),
    }
    found.write(path, laws)
    again = io.read_nav2(path)
    assert {name: again.laws[name] for name in laws} == laws
    assert again.laws["Slow"] == found.laws["Slow"]
    text = path.read_text(encoding="utf-8")
    assert "max_vel_x: 0.5   # carefully\n" in text
    assert "cost_weight: 4.0}" in text
    assert text.startswith("# by hand\n")


def test_what_cannot_be_written_is_refused(tmp_path: Path) -> None:
    found = settings(tmp_path, TEXT)
    dwb = found.laws["FollowPath"]
    for laws, words in (
        ({"Follow": dwb}, 'did you mean "FollowPath"'),
        ({"Slow": dwb}, "RegulatedPurePursuit"),
        ({"FollowPath": dwb.replaced(goal_dist_scale=3.0)}, "switches off"),
        ({"FollowPath": dwb.replaced(inflation_radius=0.7)}, "local costmap"),
    ):
        with pytest.raises(InvalidParameterError, match=words):
            found.write(tmp_path / "tuned.yaml", laws)  # type: ignore[arg-type]  # laws of this kind
    assert not (tmp_path / "tuned.yaml").exists()


@pytest.mark.parametrize(
    ("controller", "words"),
    [
        ("plugin: teb::TEB", "FollowPath.plugin must be one of dwb_core"),
        ("max_vel_x: 1.0", "FollowPath.plugin"),
        ("plugin: dwb_core::DWBLocalPlanner, vx_samples: many", "FollowPath.vx_samples must be a whole number"),
        ("plugin: dwb_core::DWBLocalPlanner, sim_time: -1", "FollowPath.sim_time must be finite and positive"),
        ("plugin: nav2_mppi_controller::MPPIController, CostCritic: {cost_power: 2}", "cost_power must be 1"),
        ("plugin: nav2_mppi_controller::MPPIController, GoalCritic: {enabled: 3}", "GoalCritic.enabled must be"),
    ],
)
def test_what_is_wrong_is_named_with_its_keys(tmp_path: Path, controller: str, words: str) -> None:
    found = settings(tmp_path, f"controller_server: {{ros__parameters: {{FollowPath: {{{controller}}}}}}}\n")
    with pytest.raises(FileError, match=words):
        _ = found.laws


def test_a_file_without_controllers_has_no_laws(tmp_path: Path) -> None:
    found = settings(tmp_path, "local_costmap: {ros__parameters: {robot_radius: 0.2}}\n")
    with pytest.raises(FileError, match=r"controller_server\.ros__parameters"):
        _ = found.laws
    assert found.period == 0.05
