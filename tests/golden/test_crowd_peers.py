"""Pedestrian models against the programs that others use, where these are installed."""

from __future__ import annotations

import importlib.util
import logging
import math
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from hrsafety import navigation as nav

GENERATOR = np.random.Generator(np.random.PCG64(19))


def missing(name: str) -> bool:
    return importlib.util.find_spec(name) is None


@pytest.mark.skipif(missing("pyrvo"), reason="pyrvo is not installed")
def test_reciprocal_people_take_the_velocities_of_pyrvo() -> None:
    import pyrvo  # type: ignore[import-untyped]  # no type information

    people, step, radius, speed = 20, 0.25, 0.3, 1.3
    place = GENERATOR.uniform(0.0, 6.0, (people, 2))
    goal = GENERATOR.uniform(0.0, 6.0, (people, 2))
    simulator = pyrvo.RVOSimulator(step, 10.0, 10, 5.0, 5.0, radius, speed)
    for x, y in place.tolist():
        simulator.add_agent((x, y))
    model = nav.crowd.ReciprocalAvoidance(margin=0.0)
    deviations = []
    for _ in range(20):
        # Each step starts from the state that pyrvo has reached: it works in single precision.
        position = np.array([simulator.get_agent_position(index).to_tuple() for index in range(people)])
        velocity = np.array([simulator.get_agent_velocity(index).to_tuple() for index in range(people)])
        way = goal - position
        length = np.hypot(*way.T)[:, None]
        wanted = way / length * np.minimum(speed, length / step)
        for index, (x, y) in enumerate(wanted.tolist()):
            simulator.set_agent_pref_velocity(index, (x, y))
        simulator.do_step()
        reached = np.array([simulator.get_agent_velocity(index).to_tuple() for index in range(people)])
        found = nav.crowd.decide(
            model, position=position, velocity=velocity, goal=goal, radius=radius, desired_speed=speed, step=step
        )
        deviations.append(np.hypot(*(found - reached).T) * step)
    # In m within a step; single precision, and parallel lines that pyrvo tells apart at 1e-5.
    assert np.median(deviations) < 1e-6
    assert np.quantile(deviations, 0.95) < 1e-5


@pytest.fixture
def quiet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Undo what a package does to logging where it is imported: handlers, level, a file in the working folder."""
    monkeypatch.chdir(tmp_path)
    before = list(logging.root.handlers)
    monkeypatch.setattr(logging.root, "handlers", list(before))
    monkeypatch.setattr(logging.root, "level", logging.root.level)
    yield
    for handler in logging.root.handlers:
        if handler not in before:
            handler.close()


@pytest.mark.usefixtures("quiet")
@pytest.mark.skipif(missing("pysocialforce"), reason="PySocialForce is not installed")
def test_pair_forces_are_those_of_pysocialforce_where_its_angle_needs_no_wrap() -> None:
    from pysocialforce import forces  # type: ignore[import-untyped]  # no type information
    from pysocialforce.utils import stateutils  # type: ignore[import-untyped]  # no type information

    model = nav.crowd.Moussaid(side_bias=0.0, cutoff=None)
    peer = forces.SocialForce()
    peer.factor = model.strength
    compared = 0
    for _ in range(400):
        position, velocity = GENERATOR.uniform(-2.0, 2.0, (2, 2)), GENERATOR.uniform(-1.0, 1.0, (2, 2))
        peer.peds = SimpleNamespace(pos=lambda at=position: at, vel=lambda at=velocity: at, size=lambda: 2)
        way = stateutils.normalize(stateutils.each_diff(position))[0]
        interaction = stateutils.normalize(2.0 * -stateutils.each_diff(velocity) + way)[0]
        turns = stateutils.vector_angles(interaction) - stateutils.vector_angles(way)
        if np.abs(turns).max() > math.pi:
            continue
        compared += 1
        # Without a wish the drive is -v/tau.
        found = nav.crowd.decide(model, position=position, velocity=velocity, goal=position, desired_speed=1.0)
        push = found + velocity / model.relaxation_time
        np.testing.assert_allclose(push, peer.get_force(), rtol=0.0, atol=1e-12)
    assert compared > 100


@pytest.mark.skipif(missing("jupedsim"), reason="JuPedSim is not installed")
def test_one_step_of_collision_free_speed_is_that_of_jupedsim() -> None:
    import jupedsim

    step, radius, speed, people = 0.05, 0.2, 1.2, 12
    area = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]
    for _ in range(5):
        place = np.array([(1.1 * (index % 4), 1.1 * (index // 4)) for index in range(people)])
        place += GENERATOR.uniform(-0.25, 0.25, place.shape)
        kind = jupedsim.CollisionFreeSpeedModel(
            strength_neighbor_repulsion=8.0,
            range_neighbor_repulsion=0.1,
            strength_geometry_repulsion=5.0,
            range_geometry_repulsion=0.02,
        )
        simulation = jupedsim.Simulation(model=kind, geometry=area, dt=step)
        goal = (15.0, 3.0)
        stage = simulation.add_waypoint_stage(goal, 0.1)
        journey = simulation.add_journey(jupedsim.JourneyDescription([stage]))
        ids = [
            simulation.add_agent(
                jupedsim.CollisionFreeSpeedModelAgentParameters(
                    position=tuple(at),
                    journey_id=journey,
                    stage_id=stage,
                    time_gap=1.0,
                    desired_speed=speed,
                    radius=radius,
                )
            )
            for at in place.tolist()
        ]
        simulation.iterate()
        moved = np.array([simulation.agent(each).position for each in ids]) - place
        found = nav.crowd.decide(
            nav.crowd.CollisionFreeSpeed(),
            position=place,
            velocity=np.zeros_like(place),
            goal=np.tile(goal, (people, 1)),
            radius=radius,
            desired_speed=speed,
            walls=[[*area, area[0]]],
        )
        np.testing.assert_allclose(found * step, moved, rtol=0.0, atol=1e-10 * float(np.abs(place).max()))


@pytest.mark.usefixtures("quiet")
@pytest.mark.skipif(missing("pysocialforce"), reason="PySocialForce is not installed")
def test_forces_of_1995_are_gradients_of_the_potential_of_pysocialforce() -> None:
    from pysocialforce import potentials  # type: ignore[import-untyped]  # no type information

    # Its own gradient takes forward differences, and its force class raises: only the potential is used.
    model = nav.crowd.SocialForce1995(behind=1.0, cutoff=None)
    potential = potentials.PedPedPotential(model.step_time, model.strength, model.range)
    shift = 1e-5
    compared = 0
    for _ in range(300):
        position, velocity = GENERATOR.uniform(-2.0, 2.0, (2, 2)), GENERATOR.uniform(-1.0, 1.0, (2, 2))
        goal = GENERATOR.uniform(-9.0, 9.0, (2, 2))
        way = goal - position
        desired = way / np.linalg.norm(way, axis=1)[:, None]
        speeds = np.linalg.norm(velocity, axis=1)
        apart = position[:, None] - position[None]
        # Away from the way of the other, where the potential has an edge.
        if potential.b(apart.copy(), speeds, desired)[~np.eye(2, dtype=bool)].min() < 0.1:
            continue
        compared += 1
        gradient = np.empty((2, 2))
        for axis in (0, 1):
            moved = shift * np.eye(2)[axis]
            ahead, back = (potential.value_r_ab(apart + sign * moved, speeds, desired) for sign in (1, -1))
            gradient[:, axis] = ((ahead - back) / (2.0 * shift)).sum(axis=1)
        found = nav.crowd.decide(model, position=position, velocity=velocity, goal=goal, desired_speed=1.0)
        push = found - (desired - velocity) / model.relaxation_time
        np.testing.assert_allclose(push, -gradient, rtol=0.0, atol=1e-5)
    assert compared > 100


@pytest.mark.skipif(missing("jupedsim"), reason="JuPedSim is not installed")
def test_one_step_of_social_force_2000_is_that_of_jupedsim() -> None:
    import jupedsim

    step, radius, speed, people = 0.01, 0.2, 1.2, 12
    area = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]
    goal = (15.0, 3.0)
    for _ in range(5):
        # Some overlap: they press and rub.
        place = np.array([(0.45 * (index % 4), 0.45 * (index // 4)) for index in range(people)])
        place += GENERATOR.uniform(-0.1, 0.1, place.shape)
        velocity = GENERATOR.uniform(-0.6, 0.6, place.shape)
        simulation = jupedsim.Simulation(model=jupedsim.SocialForceModel(), geometry=area, dt=step)
        stage = simulation.add_waypoint_stage(goal, 0.1)
        journey = simulation.add_journey(jupedsim.JourneyDescription([stage]))
        ids = [
            simulation.add_agent(
                jupedsim.SocialForceModelAgentParameters(
                    position=tuple(at),
                    velocity=tuple(moving),
                    journey_id=journey,
                    stage_id=stage,
                    mass=80.0,
                    desired_speed=speed,
                    reaction_time=0.5,
                    agent_scale=2000.0,
                    obstacle_scale=2000.0,
                    force_distance=0.08,
                    radius=radius,
                )
            )
            for at, moving in zip(place.tolist(), velocity.tolist(), strict=True)
        ]
        simulation.iterate()
        reached = np.array([simulation.agent(each).position for each in ids])
        found = nav.crowd.decide(
            nav.crowd.SocialForce2000(),
            position=place,
            velocity=velocity,
            goal=np.tile(goal, (people, 1)),
            radius=radius,
            desired_speed=speed,
            walls=[[*area, area[0]]],
        )
        moved = (velocity + step * found) * step
        np.testing.assert_allclose(reached - place, moved, rtol=0.0, atol=1e-10 * float(np.abs(place).max()))
