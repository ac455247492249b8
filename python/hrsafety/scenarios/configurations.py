"""The configurations of Zeng (2011), chapters 5 to 7, with the regions used there."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety.errors import InvalidParameterError

__all__ = ["CONFIGURATIONS", "configuration"]

_DISC_RADIUS = 0.1
_WALKING = (1.0, 0.0)


def _chapter_6(*obstacles: nav.Obstacle) -> nav.Scenario:
    return nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=obstacles)


def _chapter_7(*obstacles: nav.Obstacle) -> nav.Scenario:
    return nav.Scenario(start=(3.99, 0.6), goal=(0.0, 0.6), obstacles=obstacles)


def _person_6(start: tuple[float, float], stop: tuple[float, float]) -> nav.Human:
    return nav.Human(start=start, velocity=_WALKING, stop=stop, critical_radius=0.8, active_radius=2.1)


def _person_7(start: tuple[float, float], stop: tuple[float, float] | None) -> nav.Human:
    return nav.Human(start=start, velocity=_WALKING, stop=stop, critical_radius=0.8, active_radius=2.5)


def _disc_6(center: tuple[float, float]) -> nav.Disc:
    return nav.Disc(center=center, radius=_DISC_RADIUS, critical_radius=0.4, active_radius=0.8)


def _disc_7(center: tuple[float, float]) -> nav.Disc:
    return nav.Disc(center=center, radius=_DISC_RADIUS, critical_radius=0.4, active_radius=0.65)


def _rectangle_6() -> nav.Rectangle:
    """Return the rectangle x 1.6..3.0, y -0.3..0.3."""
    return nav.Rectangle(center=(2.3, 0.0), length=1.4, width=0.6, critical_radius=0.4, active_radius=0.8)


def _rectangle_7() -> nav.Rectangle:
    """Return the rectangle x 1.6..3.0, y -0.1..0.5; the source prints x and y exchanged."""
    return nav.Rectangle(center=(2.3, 0.2), length=1.4, width=0.6, critical_radius=0.3, active_radius=0.55)


def _c1() -> nav.Scenario:
    return _chapter_6(_disc_6((2.45, 0.595)))


def _c2() -> nav.Scenario:
    return _chapter_6(_person_6((0.6, 0.6), (4.0, 0.6)))


def _c3() -> nav.Scenario:
    return _chapter_6(_rectangle_6(), _disc_6((2.45, 1.4)))


def _c4() -> nav.Scenario:
    return _chapter_6(_person_6((0.6, 0.6), (4.0, 0.6)), _rectangle_6(), _disc_6((2.45, 1.4)))


def _n1() -> nav.Scenario:
    return _chapter_7(_disc_7((2.16, 0.6)))


def _n2() -> nav.Scenario:
    return _chapter_7(_person_7((0.2, 0.6), (4.0, 0.6)))


def _n3() -> nav.Scenario:
    return _chapter_7(_rectangle_7(), _disc_7((2.16, 1.5)))


def _n4() -> nav.Scenario:
    return _chapter_7(_person_7((0.2, 0.6), (3.9, 0.6)), _rectangle_7(), _disc_7((2.16, 1.5)))


def _parallel_human() -> nav.Scenario:
    return _chapter_6(_person_6((0.6, 1.2), (4.0, 1.2)))


def _unpredictable_human() -> nav.Scenario:
    """Return section 5.7: the person slows down to rest, then walks off sideways."""
    motion = [
        (1.0, (1.0, 0.0), (0.0, 0.0)),
        (1.0, (1.0, 0.0), (-1.0, 0.0)),
        (1.0, (0.0, 0.0), (0.0, 1.0)),
    ]
    person = nav.Human.from_segments((0.6, 0.0), motion, critical_radius=0.8, active_radius=2.1)
    return nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=(person,))


def _multiple_obstacles() -> nav.Scenario:
    """Return section 7.5.5: the person starts on the goal."""
    robot = nav.MovingDisc(
        center=(3.0, 4.0), radius=0.2, velocity=(0.0, -0.5), critical_radius=0.55, active_radius=1.35
    )
    return _chapter_7(_person_7((0.0, 0.6), None), _disc_7((4.1, 2.0)), robot)


_BUILDERS: MappingProxyType[str, Callable[[], nav.Scenario]] = MappingProxyType(
    {
        "c1": _c1,
        "c2": _c2,
        "c3": _c3,
        "c4": _c4,
        "n1": _n1,
        "n2": _n2,
        "n3": _n3,
        "n4": _n4,
        "parallel_human": _parallel_human,
        "unpredictable_human": _unpredictable_human,
        "multiple_obstacles": _multiple_obstacles,
    }
)

CONFIGURATIONS: tuple[str, ...] = tuple(_BUILDERS)
"""Names that `configuration` knows."""


def configuration(name: str) -> nav.Scenario:
    """Return one of the published configurations, for the holonomic robot.

    ``c1`` to ``c4`` are those of chapter 6, ``n1`` to ``n4`` those of chapter 7,
    ``parallel_human`` that of section 6.4.5, ``unpredictable_human`` that of section 5.7 and
    ``multiple_obstacles`` that of section 7.5.5. The radii of the regions are those that the
    source uses in its runs; chapter 7 sizes them for a nonholonomic robot. Obstacles come in
    the order person, rectangle, disc; in ``multiple_obstacles`` person, disc, robot.

    Parameters
    ----------
    name : str
        One of `CONFIGURATIONS`.

    Returns
    -------
    Scenario
        Robot, start, goal and obstacles.

    Raises
    ------
    InvalidParameterError
        If the name is unknown.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> [type(obstacle).__name__ for obstacle in scenarios.configuration("c4").obstacles]
    ['Human', 'Rectangle', 'Disc']
    """
    builder = _BUILDERS.get(name) if isinstance(name, str) else None
    if builder is None:
        rule = f"be one of {', '.join(CONFIGURATIONS)}"
        raise InvalidParameterError("name", rule, name, meant(name, CONFIGURATIONS))
    return builder()
