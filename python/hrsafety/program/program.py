"""Programs: a motion of a robot, what of it may touch whom, and how fast it may be there."""

from __future__ import annotations

from hrsafety._records import dataclass
from hrsafety.program.contacts import Waypoints
from hrsafety.program.motion import Retimed
from hrsafety.program.runs import AllowedAlong, Runs
from hrsafety.program.study import ProgramStudy, study_of
from hrsafety.program.task import ProgramTask
from hrsafety.program.zoned import SpeedZones, zones_of

__all__ = ["Program"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Program(ProgramTask):
    """A robot program with the contacts that may happen along it, of a file or made of objects; `report` judges it.

    Parameters
    ----------
    motion : ArmMotion
        The path with the limits of the joints.
    points : sequence of ContactPoint
        Places of the robot that may touch a person.
    segments : sequence of Segment
        Parts of the path with the regions of the body within reach.
    limits : LimitSet
        Limits of the contacts.
    coverings : mapping of str to Covering
        By name; cycle times are also computed with each of them on all points.
    strains : mapping of str to float or None
        Largest strain of a covering.
    drive : Drive or None
        What pushes a clamped body part.
    robot_mass : {"larger", "iso", "directional"}
        Which mass counts.
    direction : {"motion", "worst"}
        Whether the directional mass is that along the motion of a point, or along the worst normal.
    link : str or None
        Link of the tool center point; the last one that a joint moves when ``None``.
    point : sequence of three floats
        The tool center point in its frame, in m.
    tcp_speed : float or None
        Largest speed of the tool center point in m/s.
    zone_rules : ZoneRules or None
        How zones are typed into the pendant; none are made when ``None``.
    separation : mapping or None
        Rules of the stop, as in a cell file, for the distances of a scanner field.
    confirmed : mapping of str to str
        Doubts by code that somebody has confirmed not to hold here, with reason and name.
    annex : mapping
        Texts, hazards and assumptions of the annex for Regulation (EU) 2023/1230, see `contact.annex_of`.
    title : str
        Heading of the page.
    given : mapping
        What a file holds, as read.
    files : mapping of str to str
        SHA-256 of files that were read, by what they are.

    Examples
    --------
    >>> from hrsafety import arms, program
    >>> gripper = arms.Payload("tool", 1.0)
    >>> arm = arms.Arm.example(armature=[1.2, 1.2, 1.0, 0.3, 0.3, 0.3], payload=gripper)
    >>> motion = program.ArmMotion.from_waypoints(arm, {"turn": [0.0, 0.5, 1.0], "elbow": [1.4] * 3}, acceleration=4.0)
    >>> task = program.Program(
    ...     motion=motion,
    ...     points=[program.ContactPoint(name="gripper", link="tool", area=1e-4)],
    ...     segments=[program.Segment(start=0.0, end=1.0, regions=["chest"], clamped=False, reason="nothing behind")],
    ... )
    >>> task.report().verdict
    'exceeds'
    """

    @property
    def waypoints(self) -> Waypoints:
        """Places of the planned run: the samples of a log, or moves at the limits of the joints."""
        return self._runs().waypoints()

    @property
    def allowed(self) -> AllowedAlong:
        """Speeds that the limits of contacts allow at each waypoint."""
        runs = self._runs()
        return runs.allowed(runs.waypoints())

    @property
    def retimed(self) -> Retimed:
        """The fastest run within the limits of joints and contacts, with the coverings that are planned."""
        runs = self._runs()
        return runs.retimed(runs.planned)

    def zones(self) -> SpeedZones | None:
        """Return the zones as typed into the pendant, ``None`` without rules for them.

        Returns
        -------
        SpeedZones or None
            With the run that they give.
        """
        runs = self._runs()
        return zones_of(runs, runs.planned)

    def _runs(self) -> Runs:
        return Runs(self, None, None)

    def report(self, *, intervals: int | None = None, threads: int | None = None) -> ProgramStudy:
        """Return whether the program keeps the limits, how fast it may be, and what that costs.

        Parameters
        ----------
        intervals : int or None
            Of the retimed path, at least; 2,000 when ``None``.
        threads : int or None
            Number of threads; all cores when ``None``. It changes no bit.

        Returns
        -------
        ProgramStudy
            Verdict, rows, cycle times, zones and measurement plan.
        """
        return study_of(self, intervals=intervals, threads=threads)
