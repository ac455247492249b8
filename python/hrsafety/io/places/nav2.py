"""Settings of Nav2: the shape and the limits of the robot that a parameter file describes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from os import PathLike
from typing import Annotated, Any

from hrsafety._arguments import Pair, meant
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._yaml.documents import YamlDocument, YamlSection
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.io.places.nav2_laws import (
    INFLATION,
    Nav2Controller,
    approaches_of,
    changes,
    controllers_of,
    doubts_of,
    ignored_of,
)
from hrsafety.io.reader import Document, Provenance
from hrsafety.navigation.laws.twists import LocalPlanner
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.robots.footprint import Footprint, corners_of
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["Nav2Settings", "costmap_footprint", "read_nav2"]

PADDING = 0.01
"""Default of ``footprint_padding`` in m."""
RADIUS = 0.1
"""Default of ``robot_radius`` in m."""
CORNERS = 16
"""Corners of the footprint that Nav2 makes of a radius."""
FREQUENCY = 20.0
"""Default of ``controller_frequency`` in Hz."""
SAME = 1e-6
Parameters = dict[str, YamlSection]
"""Parameters of a node by their names with dots."""
_QUANTITIES = {
    "circumscribed_radius": "nav2_radius",
    "max_speed": "robot_max_speed",
    "max_turn_rate": "robot_max_turn_rate",
    "max_acceleration": "robot_max_acceleration",
    "max_deceleration": "robot_max_deceleration",
}
_SMOOTHED = (("max_velocity", 1.0), ("min_velocity", -1.0), ("max_accel", 1.0), ("max_decel", -1.0))
_DRIVES = {"DiffDrive": "two wheels", "Omni": "holonomic", "Ackermann": "car"}
_COSTMAPS = ("local_costmap", "global_costmap")
# What the controllers call a limit: DWB, MPPI, RPP and its older name.
_SPEED = ("max_vel_x", "vx_max", "max_linear_vel", "desired_linear_vel")
_REVERSE = ("min_vel_x", "vx_min")
_LATERAL = ("max_vel_y", "vy_max")
_TURN = ("max_vel_theta", "wz_max", "max_angular_vel")
_SPEED_UP = ("acc_lim_x", "ax_max")
_BRAKE = ("decel_lim_x", "ax_min")
_TURN_UP = ("acc_lim_theta", "az_max", "max_angular_accel")

_INFLATION_CODE = "inflation_below_circumscribed"


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Nav2Settings:
    """Shape and limits of a robot as a parameter file of Nav2 gives them; what it does not say is ``None``.

    Of controller and velocity smoother the stricter limit counts; of several controllers the one that allows more.

    Attributes
    ----------
    footprint : tuple of (float, float) or None
        Corners of the footprint in m, without padding; ``None`` for a round robot.
    robot_radius : float or None
        Radius of a round robot in m.
    footprint_padding : float or None
        By how much each coordinate of the footprint is moved away from zero, in m.
    padded : tuple of (float, float) or None
        Corners with padding in m; of a round robot the 16 that Nav2 makes of it.
    circumscribed_radius, inscribed_radius : float or None
        Largest and smallest distance of the padded outline from the center, in m.
    inflation_radius : float or None
        Of the inflation layer, in m.
    cost_scaling_factor : float or None
        Of the inflation layer, per meter.
    max_speed, min_speed : float or None
        Largest forward speed, and the smallest (negative in reverse), in m/s.
    max_lateral_speed : float or None
        Largest sideways speed in m/s.
    max_turn_rate : float or None
        In rad/s.
    max_acceleration : float or None
        Along the way, in m/s^2.
    max_deceleration : float or None
        Along the way, positive, in m/s^2.
    max_turn_acceleration : float or None
        In rad/s^2.
    drive : {"two wheels", "holonomic", "car"}
        By the motion model of MPPI, else two wheels unless a sideways speed is allowed.
    period : float
        Control period in s: the inverse of ``controller_frequency``, 20 Hz by default.
    monitor : mapping of str to dict
        Polygons of the collision monitor that slow the robot in time, by their names: ``time_before_collision`` and
        ``simulation_time_step``, both in seconds.
    ignored : tuple of str
        Keys of controller server, local costmap and collision monitor that nothing here uses, with their paths.
    warnings : tuple of ResultWarning
        ``two_footprints`` where local and global costmap differ, ``inflation_below_circumscribed``, ``assumed`` for
        defaults of Nav2 and the encoding, ``implausible`` numbers.
    source : Provenance
        The file.
    """

    footprint: Annotated[tuple[Pair, ...] | None, "m"] = None
    robot_radius: Annotated[float | None, "m"] = None
    footprint_padding: Annotated[float | None, "m"] = None
    padded: Annotated[tuple[Pair, ...] | None, "m"] = None
    circumscribed_radius: Annotated[float | None, "m"] = None
    inscribed_radius: Annotated[float | None, "m"] = None
    inflation_radius: Annotated[float | None, "m"] = None
    cost_scaling_factor: float | None = None
    max_speed: Annotated[float | None, "m/s"]
    min_speed: Annotated[float | None, "m/s"]
    max_lateral_speed: Annotated[float | None, "m/s"]
    max_turn_rate: Annotated[float | None, "rad/s"]
    max_acceleration: Annotated[float | None, "m/s^2"]
    max_deceleration: Annotated[float | None, "m/s^2"]
    max_turn_acceleration: Annotated[float | None, "rad/s^2"]
    drive: str
    period: Annotated[float, "s"] = 1.0 / FREQUENCY
    monitor: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    ignored: tuple[str, ...] = ()
    warnings: tuple[ResultWarning, ...]
    source: Provenance
    _controllers: tuple[Nav2Controller, ...] | FileError = field(default=(), repr=False, compare=False)
    _document: YamlDocument | None = field(default=None, repr=False, compare=False)

    @property
    def body_warnings(self) -> tuple[ResultWarning, ...]:
        """The `warnings` but those about how a planner inflates obstacles."""
        return tuple(each for each in self.warnings if each.code != _INFLATION_CODE)

    @property
    def laws(self) -> Mapping[str, LocalPlanner]:
        """Laws of the controllers by their names.

        Parameters that a file leaves out have the defaults of the laws; those of ``batch_size``, ``time_steps`` and
        ``model_dt`` are Nav2's own.

        Raises
        ------
        FileError
            If there is no controller, a plugin is none of those known, or a parameter breaks its rule; the error names
            the key with its path.
        """
        found = self._controllers
        if isinstance(found, FileError):
            raise found
        return {each.name: each.law for each in found}

    def write(self, path: str | PathLike[str], laws: Mapping[str, LocalPlanner] | None = None) -> None:
        """Write the file again with other parameters of its controllers; comments and all else stay.

        Parameters
        ----------
        path : path
            Where.
        laws : mapping of str to law or None
            Laws by the names of the controllers; only what they have otherwise than `laws` is changed.

        Raises
        ------
        InvalidParameterError
            If there is no controller of a name, or it is another law.
        FileError
            As for `laws`.
        OSError
            If it cannot be written; an older file stays as it was.
        """
        document = self._document
        if document is None:
            raise InvalidParameterError("settings", "come from a file", Shown("none"), "read them with read_nav2")
        own = self.laws
        values: dict[tuple[str | int, ...], Any] = {}
        for name, law in (laws or {}).items():
            if name not in own:
                raise InvalidParameterError("laws", f"be named {' or '.join(own)}", name, meant(str(name), own))
            if type(law) is not type(own[name]):
                raise InvalidParameterError(f"laws[{name!r}]", f"be a {type(own[name]).__name__}", law)
            controller = next(each for each in self._controllers if each.name == name)  # type: ignore[union-attr]
            values |= dict(changes(controller, law))
        document.changed(values).write(path)

    def robot(self, **given: Any) -> DifferentialDriveRobot | HolonomicRobot:
        r"""Return the robot with the padded footprint of the file, or the disc of the circumscribed radius.

        Parameters
        ----------
        **given
            Arguments of `DifferentialDriveRobot` or `HolonomicRobot` that the file does not give, such as ``mass``, or
            that are to be others; with a ``radius`` the robot is a disc.

        Returns
        -------
        DifferentialDriveRobot or HolonomicRobot
            By its drive.

        Raises
        ------
        InvalidParameterError
            If the file gives no speed or acceleration and the call does not either, the drive is that of a car, or the
            footprint cannot be a body: it must hold the origin, and three corners that differ.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> from hrsafety import io
        >>> lines = [
        ...     "local_costmap: {local_costmap: {ros__parameters: {robot_radius: 0.2}}}",
        ...     "velocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0], max_accel: [2.5, 0.0, 3.2]}}",
        ... ]
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = pathlib.Path(folder, "nav2_params.yaml")
        ...     _ = path.write_text("\n".join(lines))
        ...     robot = io.read_nav2(path).robot(mass=20.0)
        >>> robot.max_speed, robot.max_turn_rate, round(robot.radius, 3)
        (0.5, 2.0, 0.214)
        """
        if self.drive == "car":
            shown = Shown("the motion model Ackermann")
            raise InvalidParameterError("drive", "be two wheels or holonomic", shown, "make the robot by hand")
        named: dict[str, Any] = {
            "radius": self.circumscribed_radius,
            "max_speed": None if self.drive == "holonomic" else self.max_speed,
            "max_acceleration": self.max_acceleration,
            "max_deceleration": self.max_deceleration,
        }
        if self.drive == "two wheels":
            named |= {"max_turn_rate": self.max_turn_rate, "max_turn_acceleration": self.max_turn_acceleration}
        if not {"radius", "footprint"} & set(given):
            named["footprint"] = body_of(self)
        found = {name: value for name, value in named.items() if value is not None} | given
        if self.drive == "holonomic" and self.max_speed is not None:  # forward and sideways at once
            found.setdefault(
                "max_speed",
                math.hypot(self.max_speed, self.max_speed if (side := self.max_lateral_speed) is None else side),
            )
        if "footprint" in found:
            found.pop("radius", None)
        for name in ("footprint" if "footprint" in found else "radius", "max_speed", "max_acceleration"):
            if name not in found:
                raise InvalidParameterError(name, "stand in the file or the call", Shown("neither"), f"give {name}=")
        return (DifferentialDriveRobot if self.drive == "two wheels" else HolonomicRobot)(**found)


def read_nav2(path: str | PathLike[str]) -> Nav2Settings:
    """Return shape and limits of the robot from a parameter file of Nav2.

    Read are the footprints of the costmaps with their padding and inflation, the limits of the controllers (DWB, MPPI,
    RPP) and of the velocity smoother, and the controllers as laws.

    Parameters
    ----------
    path : path
        The YAML file.

    Returns
    -------
    Nav2Settings
        Its ``robot()`` is one for scenarios and worlds.

    Raises
    ------
    InvalidParameterError
        If there is no such file.
    FileError
        If it is no YAML, holds none of these parameters, or one breaks its rule; the error names file, line and keys.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import io
    >>> text = '''
    ... local_costmap:
    ...   local_costmap:
    ...     ros__parameters:
    ...       footprint: "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"
    ... controller_server:
    ...   ros__parameters:
    ...     FollowPath: {plugin: "dwb_core::DWBLocalPlanner", max_vel_x: 0.26, max_vel_theta: 1.0, acc_lim_x: 2.5}
    ... '''
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "nav2_params.yaml")
    ...     _ = path.write_text(text)
    ...     settings = io.read_nav2(path)
    >>> settings.max_speed, settings.drive, round(settings.circumscribed_radius, 4)
    (0.26, 'two wheels', 0.3744)
    >>> settings.laws["FollowPath"].acc_lim_x, settings.period
    (2.5, 0.05)
    """
    document = Document(path)
    yaml = YamlDocument(document.text, document.name)
    root = yaml.root
    doubts = list(document.warnings)
    costmaps = {name: found for name in _COSTMAPS if (found := _node(root, name, name)) is not None}
    server, smoother = _node(root, "controller_server"), _node(root, "velocity_smoother")
    if not costmaps and server is None and smoother is None:
        keys = root.keys()
        alike = meant("controller_server", keys)
        rule = "hold the parameters of a costmap, controller_server or velocity_smoother"
        raise document.error("missing_key", rule, Shown(", ".join(keys[:20]) or "nothing"), alike)
    monitor = _node(root, "collision_monitor") or {}
    shapes = {name: _shape(costmap) for name, costmap in costmaps.items()}
    shape = next((each for each in shapes.values() if each["given"]), next(iter(shapes.values()), None))
    doubts += _doubts_of_shapes(shapes, shape)
    limits = _limits(server, smoother)
    named = limits | {"circumscribed_radius": None if shape is None else shape["circumscribed_radius"]}
    doubts += implausible({name: named[name] for name in _QUANTITIES}, _QUANTITIES)
    local = costmaps.get("local_costmap", {})
    approaches = approaches_of(monitor)
    try:
        read = tuple(_read_controllers(root, server, shapes.get("local_costmap", {})))
    except FileError as error:
        controllers: tuple[Nav2Controller, ...] | FileError = error
    else:
        controllers = read
        doubts += [doubt for each in read for doubt in doubts_of(each)]
    return Nav2Settings(
        period=1.0 / _frequency(server),
        monitor=approaches,
        ignored=tuple(ignored_of((server or {}, local, monitor), controllers, _OF_ROBOT)),
        _controllers=controllers,
        _document=yaml,
        **({name: each for name, each in shape.items() if name != "given"} if shape else {}),
        **limits,
        warnings=tuple(doubts),
        source=Provenance(path=str(path), format="nav2", sha256=document.sha256),
    )


def _node(root: YamlSection, *names: str) -> Parameters | None:
    """Return the parameters of a node, below its name once or twice, in a namespace or not; ``None`` without any."""
    tops = [root, *(each for key in root if (each := root[key]).is_map and key not in names)]
    for top in tops:
        for path in (names, names[:1], ("/".join(names),), ("/" + "/".join(names),)):
            found: YamlSection | None = top
            for key in (*path, "ros__parameters"):
                found = found.get(key) if found is not None and found.is_map else None
            if found is not None and found.is_map:
                parameters: Parameters = {}
                for name, each in _flat(found, ""):
                    if name in parameters:
                        raise each.error(f"stand once, {name} stands in line {parameters[name].line}, too")
                    parameters[name] = each
                return parameters
    return None


def _flat(section: YamlSection, above: str) -> Iterator[tuple[str, YamlSection]]:
    """Yield parameters by their names with dots, as ROS knows them: maps and dots in keys are the same to it."""
    for key in section:
        if section[key].is_map:
            yield from _flat(section[key], f"{above}{key}.")
        else:
            yield f"{above}{key}", section[key]


# ---- shape -----------------------------------------------------------------------------------------


def costmap_footprint(entry: YamlSection) -> tuple[Pair, ...]:
    """Return the corners of a footprint as Nav2 writes them: text of pairs in brackets; none for an empty one."""
    if entry.is_list:
        raise entry.error("be text, as the costmap reads it", "put quotes around it")
    found = corners_of(entry.text())
    if isinstance(found, str):
        raise entry.error(found, code="footprint")
    return found


def _shape(costmap: Parameters) -> dict[str, Any]:
    """Return the shape of the robot in a costmap."""
    entry, round_entry = costmap.get("footprint"), costmap.get("robot_radius")
    corners = () if entry is None else costmap_footprint(entry)
    radius = RADIUS if round_entry is None else _positive(round_entry)
    padding_entry = costmap.get("footprint_padding")
    padding = PADDING if padding_entry is None else padding_entry.number()
    if padding < 0.0 and padding_entry is not None:
        raise padding_entry.error("not be negative")
    turns = (2.0 * math.pi * index / CORNERS for index in range(CORNERS))
    outline = corners or tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)
    padded = tuple((_away(x, padding), _away(y, padding)) for x, y in outline)
    layers = [key.rpartition(".")[0] for key in costmap if key.endswith(".inflation_radius")]
    layer = "inflation_layer" if "inflation_layer" in layers else layers[0] if layers else ""
    inflation, scaling = costmap.get(f"{layer}.inflation_radius"), costmap.get(f"{layer}.cost_scaling_factor")
    return {
        "given": bool(corners) or round_entry is not None,
        "footprint": corners or None,
        "robot_radius": None if corners else radius,
        "footprint_padding": padding,
        "padded": padded,
        "circumscribed_radius": max(math.hypot(x, y) for x, y in padded),
        "inscribed_radius": min(_distance(a, b) for a, b in zip(padded, (*padded[1:], padded[0]), strict=True)),
        "inflation_radius": None if inflation is None else inflation.number(),
        "cost_scaling_factor": None if scaling is None else scaling.number(),
    }


def _away(value: float, padding: float) -> float:
    return value + math.copysign(padding, value) if abs(value) > SAME * SAME else value


def _distance(first: Pair, last: Pair) -> float:
    """Return the distance of a segment from the origin."""
    (x, y), (u, v) = first, (last[0] - first[0], last[1] - first[1])
    square = u * u + v * v
    share = min(max(-(x * u + y * v) / square, 0.0), 1.0) if square else 0.0
    return math.hypot(x + share * u, y + share * v)


def body_of(settings: Nav2Settings) -> Footprint | None:
    """Return the padded footprint of settings, ``None`` for a round robot; an error names the footprint.

    Parameters
    ----------
    settings : Nav2Settings
        Of `read_nav2`.

    Returns
    -------
    Footprint or None
        Its convex outline.

    Raises
    ------
    InvalidParameterError
        If it does not hold the origin, or three corners that differ.
    """
    if settings.footprint is None or settings.padded is None:
        return None
    try:
        return Footprint.around(settings.padded)
    except InvalidParameterError as error:
        raise error.renamed("footprint") from None


def _doubts_of_shapes(shapes: dict[str, dict[str, Any]], shape: dict[str, Any] | None) -> Iterator[ResultWarning]:
    """Yield doubts about footprints and inflation."""
    if shape is None:
        return
    yield from _doubts_of_outline(shape)
    if not shape["given"]:
        message = f"no costmap gives a footprint or robot_radius: Nav2 takes a radius of {RADIUS} m"
        yield ResultWarning("assumed", "robot_radius", message)
    if len(shapes) == 2:
        local, other = shapes["local_costmap"], shapes["global_costmap"]
        if not _same(local["padded"], other["padded"]):
            message = (
                f"local and global costmap have other footprints, of circumscribed radius "
                f"{local['circumscribed_radius']:.3g} and {other['circumscribed_radius']:.3g} m; "
                f"{shape['circumscribed_radius']:.3g} m is taken: plans may lead through gaps that are too narrow"
            )
            yield ResultWarning("two_footprints", "footprint", message)
    short = {
        name: (each["inflation_radius"], each["circumscribed_radius"])
        for name, each in shapes.items()
        if each["inflation_radius"] is not None and each["inflation_radius"] < each["circumscribed_radius"]
    }
    if short:
        told = " and ".join(f"{small:g} m of the {name} ({large:.3g} m)" for name, (small, large) in short.items())
        message = (
            f"inflation_radius is less than the circumscribed radius: {told}; costs do not tell where a turning robot "
            "touches"
        )
        yield ResultWarning(_INFLATION_CODE, "inflation_radius", message)


def _doubts_of_outline(shape: dict[str, Any]) -> Iterator[ResultWarning]:
    """Yield doubts about padding that is large beside the robot, and about corners that stand twice."""
    corners: tuple[Pair, ...] = shape["footprint"] or ()
    padding: float = shape["footprint_padding"]
    bare = max((math.hypot(x, y) for x, y in corners), default=shape["robot_radius"])
    if padding > 0.5 * bare:
        message = (
            f"footprint_padding is {padding:g} m, more than half of the {bare:.3g} m that the robot reaches: mm or cm "
            "given for m, of one of both?"
        )
        yield ResultWarning("implausible", "footprint_padding", message)
    # The first corner may close the outline at its end.
    places = corners[:-1] if len(corners) > 1 and math.dist(corners[0], corners[-1]) < SAME else corners
    for last, place in enumerate(places):
        for first in range(last):
            if math.dist(places[first], place) < SAME:
                message = (
                    f"corners {first + 1} and {last + 1} of footprint are both ({place[0]:g}, {place[1]:g}) m: one is "
                    "written twice, and another one may be missing"
                )
                yield ResultWarning("repeated_corners", "footprint", message)
                return


def _same(one: Sequence[Pair], other: Sequence[Pair]) -> bool:
    return len(one) == len(other) and all(math.dist(a, b) < SAME for a, b in zip(one, other, strict=True))


# ---- limits ----------------------------------------------------------------------------------------


def _limits(server: Parameters | None, smoother: Parameters | None) -> dict[str, Any]:
    """Return the limits of the robot by the names of `Nav2Settings`."""
    controllers = [] if server is None else list(_controllers(server))
    smooth = {name: _smoothed(smoother, name, sign) for name, sign in _SMOOTHED}
    forward = _strict(max(_values(controllers, _SPEED), default=None), smooth["max_velocity"][0])
    lateral = _strict(max(_values(controllers, _LATERAL), default=None), smooth["max_velocity"][1])
    reverse = _strict(max(_values(controllers, _REVERSE, -1.0), default=None), _negated(smooth["min_velocity"][0]))
    turn = _strict(max(_values(controllers, _TURN), default=None), smooth["max_velocity"][2])
    speed_up = _strict(max(_values(controllers, _SPEED_UP), default=None), smooth["max_accel"][0])
    brake = _strict(min(_values(controllers, _BRAKE), default=None), _negated(smooth["max_decel"][0]))
    turn_up = _strict(max(_values(controllers, _TURN_UP), default=None), smooth["max_accel"][2])
    drives = [_drive(each) for each in controllers if "motion_model" in each]
    return {
        "max_speed": forward,
        "min_speed": _negated(reverse),
        "max_lateral_speed": lateral,
        "max_turn_rate": turn,
        "max_acceleration": speed_up,
        "max_deceleration": brake,
        "max_turn_acceleration": turn_up,
        "drive": drives[0] if drives else "holonomic" if lateral else "two wheels",
    }


def _drive(controller: Parameters) -> str:
    """Return the drive of a motion model of MPPI: a word, or the name of a plugin."""
    model = controller["motion_model"]
    name = controller.get(f"{model.text()}.plugin", model)
    for word, drive in _DRIVES.items():
        if word in name.text():
            return drive
    raise name.error('be "DiffDrive", "Omni" or "Ackermann"', meant(name.text(), tuple(_DRIVES)))


def _smoothed(smoother: Parameters | None, name: str, sign: float) -> list[float] | tuple[None, None, None]:
    """Return limits of x, y and turning that have a sign, as Nav2 wants it."""
    if smoother is None or name not in smoother:
        return None, None, None
    found = smoother[name].numbers(3)
    if any(sign * each < 0.0 for each in found):
        raise smoother[name].error(f"be {'positive' if sign > 0.0 else 'negative'} or zero")
    return found


def _controllers(server: Parameters) -> Iterator[Parameters]:
    """Yield the parameters of the controllers: those that are named, else FollowPath."""
    named = server.get("controller_plugins")
    for name in ["FollowPath"] if named is None else named.texts():
        if name in server:
            raise server[name].error("be a map of keys and values")
        yield {key[len(name) + 1 :]: each for key, each in server.items() if key.startswith(f"{name}.")}


def _values(controllers: Sequence[Parameters], keys: Sequence[str], sign: float = 1.0) -> Iterator[float]:
    """Yield a limit of each controller that has one."""
    for controller in controllers:
        entries = [controller[key] for key in keys if key in controller][:1]
        if keys is _SPEED and "max_speed_xy" in controller:
            entries.append(controller["max_speed_xy"])
        for entry in entries:
            if keys in (_SPEED, _SPEED_UP) and not entry.number() > 0.0:
                raise entry.error("be positive")
        if entries:
            yield min(sign * each.number() if sign < 0.0 else abs(each.number()) for each in entries)


def _strict(*limits: float | None) -> float | None:
    """Return the smallest of the limits that there are."""
    return min((each for each in limits if each is not None), default=None)


def _negated(value: float | None) -> float | None:
    return None if value is None else 0.0 - value


def _positive(entry: YamlSection) -> float:
    value = entry.number()
    if not value > 0.0:
        raise entry.error("be finite and positive")
    return value


# ---- controllers -----------------------------------------------------------------------------------

# Keys that shape and limits of the robot are read from, below a controller or a costmap.
_OF_ROBOT = frozenset(
    (
        *(*_SPEED, *_REVERSE, *_LATERAL, *_TURN, *_SPEED_UP, *_BRAKE, *_TURN_UP, "max_speed_xy", "motion_model"),
        *("footprint", "robot_radius", "footprint_padding", "inflation_radius", "cost_scaling_factor"),
    )
)


def _frequency(server: Parameters | None) -> float:
    entry = (server or {}).get("controller_frequency")
    return FREQUENCY if entry is None else _positive(entry)


def _read_controllers(
    root: YamlSection, server: Parameters | None, shape: Mapping[str, Any]
) -> Iterator[Nav2Controller]:
    """Return the controllers of a file as laws."""
    if server is None:
        raise root.error("hold the section controller_server.ros__parameters", code="missing_key")
    named = server.get("controller_plugins")
    names = ["FollowPath"] if named is None else named.texts()
    found = dict(zip(names, _controllers(server), strict=True))
    for name, parameters in found.items():
        if "plugin" not in parameters:
            above = next(iter(parameters.values()), next(iter(server.values()), root))
            raise above.error(f"stand beside {name}.plugin, which says what the controller is", code="missing_key")
    return controllers_of(found, {name: shape.get(name) for name in INFLATION})
