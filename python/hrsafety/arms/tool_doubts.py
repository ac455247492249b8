"""Why the masses of an arm may lack its tool."""

from __future__ import annotations

import numpy as np

from hrsafety.arms.arm import Arm
from hrsafety.plausibility import ResultWarning

__all__ = ["doubts_of_tool"]

TOOL = 0.05
"""A point farther than this from the flange, in m, is on a tool."""


def doubts_of_tool(arm: Arm, link: str, point: object) -> tuple[ResultWarning, ...]:
    """Return the doubt about a point of an arm without payload beyond whose flange nothing weighs: a tool is missing.

    Parameters
    ----------
    arm : Arm
        With what it carries.
    link : str
        Link of the point. One that weighs something itself, or stands beside others that do, is no frame of a tool
        without mass.
    point : array_like (3,)
        In the frame of the link, in m.

    Returns
    -------
    tuple of ResultWarning
        One at most.
    """
    facts = arm._facts
    names, parents, bodies = arm.link_names, facts["parents"], facts["segments"]
    masses = np.asarray(facts["link_masses"])
    here = names.index(link)
    if arm.payload_mass > 0.0 or masses[here] > 0.0 or bodies[here] is None:
        return ()
    flange = here
    while (before := parents[flange]) is not None and bodies[before] == bodies[here] and masses[before] == 0.0:
        flange = before
    places = ((link, point), (names[flange], np.zeros(3)))
    ends = [arm.position(link=name, point=place, check_limits=False) for name, place in places]
    away = float(np.linalg.norm(ends[0] - ends[1]))
    remedy = "give the tool and what it holds as payload, or confirm that the arm works without"
    if away > TOOL:
        message = f"the point on {link} is {1e3 * away:.0f} mm off the flange, where nothing weighs: {remedy}"
        return (ResultWarning("tool_without_mass", "payload", message),)
    # A body that moves others is no end of the arm; one of several links with mass has its tool among them.
    own = sum(bool(mass) for mass, body in zip(masses, bodies, strict=True) if body == bodies[here])
    last = all(
        bodies[each] == bodies[here] or before is None or bodies[before] != bodies[here]
        for each, before in enumerate(parents)
    )
    if not last or own > 1:
        return ()
    message = f"{link} is the end of the arm, and nothing weighs beyond its flange: {remedy}"
    return (ResultWarning("tool_without_mass", "payload", message),)
