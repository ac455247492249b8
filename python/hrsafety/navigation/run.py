"""A run that is advanced from outside, one control period at a time."""

from __future__ import annotations

from dataclasses import replace
from typing import NoReturn, cast

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import checked_seed, finite_pair, flag, instance, number
from hrsafety.errors import InvalidParameterError, SimulationError
from hrsafety.navigation.laws.python_law import AnyLaw, PythonLaw, as_law
from hrsafety.navigation.laws.safe_navigation import SafetyTrace
from hrsafety.navigation.laws.situation import Situation, fixed, point_mass_of, situation_of
from hrsafety.navigation.outcomes import Outcome
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling

__all__ = ["Run"]


class Run:
    """A run that is advanced from outside, one control period at a time.

    Every `step` decides, moves the robot until the next sample and measures there. Stepped to the
    end by its law, a run has the same bits as `simulate`; the force is always held for a control
    period and the motion that of ``"semi_implicit_euler"``.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement.
    law : Law, callable, object or None
        What drives the robot in steps without a command; ``None``: every step needs one.
    built : AsBuilt or None
        How the robot is built; ``None``: as `simulate` has it.
    seed : int or None
        Seed of noise and of laws that draw, in place of the scenario's own.
    step : float
        Motion step in s, which divides the control period.
    stop_on_contact : bool
        Whether the run ends at the first contact.

    Raises
    ------
    InvalidParameterError
        If an argument is not valid.

    Notes
    -----
    Runs are independent of each other and may be stepped in turn, or each in a thread of its own.
    A run that is under way cannot be copied or pickled.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.Run(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> while not run.finished:
    ...     seen = run.step()
    >>> run.outcome, round(run.time, 2)
    ('arrived', 6.63)

    Without a law every step takes a force, or a velocity to have at the next sample:

    >>> run = nav.Run(scenarios.configuration("c1"))
    >>> while not run.finished and run.time < 1.0:
    ...     seen = run.step(velocity=(-0.5, 0.2))
    >>> seen.velocity.round(2).tolist()
    [-0.5, 0.2]
    """

    __slots__ = ("_built", "_commanded", "_goal", "_how", "_law", "_native", "_robot", "_scenario", "_step")

    @telling(lambda _, *given, **named: of_scenarios(*given, **named))
    def __init__(
        self,
        scenario: Scenario,
        law: AnyLaw | None = None,
        built: AsBuilt | None = None,
        *,
        seed: int | None = None,
        step: float = 0.01,
        stop_on_contact: bool = False,
    ) -> None:
        scene = instance("scenario", scenario, Scenario)
        self._scenario = scene if seed is None else replace(scene, seed=checked_seed("seed", seed))
        self._law = None if law is None else as_law(law)
        self._built = built is not None or not isinstance(scene.robot, HolonomicRobot)
        how = AsBuilt() if built is None else instance("built", built, AsBuilt)
        self._how = how
        native = self._scenario._native
        self._robot = point_mass_of(native.point_mass())
        self._goal = fixed(scene.goal)
        self._step = number("step", step)
        self._commanded = 0
        self._native = _hrsafety.Run(
            native,
            None if self._law is None else self._law._native,
            how._native,
            step=self._step,
            stop_on_contact=flag("stop_on_contact", stop_on_contact),
        )

    @property
    def scenario(self) -> Scenario:
        """The scenario, with the seed of the run."""
        return self._scenario

    @property
    def time(self) -> float:
        """Present time in s; after the end, when the run ended."""
        return self._native.time

    @property
    def finished(self) -> bool:
        """Whether the run has ended."""
        return self._native.outcome is not None

    @property
    def outcome(self) -> Outcome | None:
        """How the run ended; ``None`` while it is under way."""
        return cast("Outcome | None", self._native.outcome)

    @property
    def trajectory(self) -> Trajectory:
        """The run so far, with outcome ``"running"`` while it is under way.

        In a run without a law, its law is one by the name of ``"commands"``.
        """
        fields = self._native.recorded(motors=self._built)
        law = _COMMANDS if self._law is None else self._law
        return Trajectory(
            scenario=self._scenario,
            law=law,
            built=self._how if self._built else None,
            motion_step=self._step,
            commanded_periods=self._commanded,
            **fields,
        )

    @property
    def trace(self) -> SafetyTrace | None:
        """Decisions of the parts around the law in the last control period; ``None`` without parts."""
        found = self._native.trace
        if found is None:
            return None
        (wanted_x, wanted_y), (x, y), taken_over, status = found
        return SafetyTrace((wanted_x, wanted_y), (x, y), taken_over, status)

    def observe(self) -> Situation:
        """Return what the controller sees now, measured once a control period.

        Returns
        -------
        Situation
            The same until the next `step`; after the end, what is measured at the end of the last
            motion step.
        """
        return situation_of(self._native.situation(), self._robot, self._goal)

    def step(self, command: npt.ArrayLike | None = None, *, velocity: npt.ArrayLike | None = None) -> Situation:
        """Advance by one control period, or to the end of the run.

        Parameters
        ----------
        command : array_like of shape (2,) or None
            Force in N until the next sample, before the limits of the robot.
        velocity : array_like of shape (2,) or None
            Velocity in m/s to have at the next sample, in place of a force: ``m (v* - V)/T_s``, as
            planners ask for it. Without either, the law decides.

        Returns
        -------
        Situation
            What the controller sees then.

        Raises
        ------
        InvalidParameterError
            If force and velocity are given, or neither in a run without a law, or one is not finite.
        ShapeError
            If one has another shape than (2,).
        SimulationError
            If the run has ended, the state became non-finite, or another thread is stepping it.
        """
        if self.finished:
            raise SimulationError(f"the run has ended ({self.outcome} at t = {self.time:.6g} s); make another Run")
        if command is not None and velocity is not None:
            raise InvalidParameterError("velocity", "be None where a force is given", velocity)
        if command is None and velocity is None and self._law is None:
            raise InvalidParameterError("command", "be a force in a run without a law", None, "or give velocity=(x, y)")
        self._native.step(
            force=None if command is None else finite_pair("command", command),
            velocity=None if velocity is None else finite_pair("velocity", velocity),
        )
        self._commanded += command is not None or velocity is not None
        return self.observe()

    def __repr__(self) -> str:
        """Return law, time and outcome."""
        return f"Run(law={self._law!r}, time={self.time:.6g}, outcome={self.outcome!r})"

    def __reduce__(self) -> NoReturn:
        """Refuse: a law may remember anything, and its copy would not be independent."""
        raise SimulationError(
            "a Run cannot be copied or pickled; make another with the same arguments and step it again"
        )


def _commands(_: Situation) -> NoReturn:
    raise SimulationError("the run had no law: its commands came from outside")


_COMMANDS = PythonLaw(function=_commands, name="commands")
