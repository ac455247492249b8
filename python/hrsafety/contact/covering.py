"""Coverings of a robot and regions of a body."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import not_negative, number, positive, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.contact.materials import Linear, Material, StressTable, material
from hrsafety.errors import InvalidParameterError

__all__ = ["CompressedCovering", "Covering", "Region", "covering_of", "region_of", "shape_flags"]

SHAPES = ("flat", "curved", "sphere", "cylinder")
_NEEDED = {"flat": ("area",), "curved": ("radius",), "sphere": ("radius",), "cylinder": ("radius", "length")}
_LEAST_RADIUS = 0.2
"""A radius below this share of the thickness is an edge."""
_DEEPEST = 0.99
"""Strain at which a foam that is linear all through its thickness meets the backing."""
Numbers = tuple[float, ...]


@displayed
class CompressedCovering(NamedTuple):
    """A covering at rest under a compression.

    Attributes
    ----------
    force : float
        In N, the backing with it.
    energy : float
        Stored work in J.
    peak_pressure : float
        Stress at the deepest place, in Pa.
    half_widths : tuple of float or None
        sqrt(2 R d) for both radii in m; ``None`` of flat contacts.
    status : tuple of str
        ``"outside_paraboloid"`` if the compression is more than half of a radius, ``"beyond_pad"`` if the
        contact is wider than the half-width that was given, ``"edge"`` if a radius is below a fifth of the
        thickness; empty if none holds.
    """

    force: Annotated[float, "N"]
    energy: Annotated[float, "J"]
    peak_pressure: Annotated[float, "Pa"]
    half_widths: Annotated[tuple[float, float] | None, "m"]
    status: tuple[str, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Covering:
    """A covering that bottoms out.

    Parameters
    ----------
    material : Material or mapping
        Its law of stress over strain, see `contact.material`.
    thickness : float
        T in m.
    shape : {"flat", "curved", "sphere", "cylinder"}
        Shape of the contact.
    area : float or None
        A in m^2, of flat contacts.
    radius, second_radius : float or None
        R1 and R2 in m of curved contacts, 1/R = 1/R_robot + 1/R_body in each direction; both are one
        where the second is not given.
    length : float or None
        l in m, of cylinders.
    damping : float
        C_c in N s/m, in parallel.
    rate : tuple of three floats
        a, b and e0 (1/s) of the factor (1 + v/(T e0))^(a + b e).
    unloading : tuple of two floats
        H and s of the factor 1 - (1-H) (1 - (w(e)/w(e_max))^s).
    bottom : tuple of two floats
        Strain e_b from which a backing of stiffness K_b (N/m) acts; K_b = 0: none.
    half_width : float or None
        Half-width of the pad under a curved contact in m, for `CompressedCovering.status`; ``None`` for a flat one.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the stress falls before e_b.

    Examples
    --------
    >>> from hrsafety import contact
    >>> foam = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)
    >>> pad = contact.Covering(material=foam, thickness=0.02, shape="flat", area=4e-3)
    >>> round(pad.column(0.005).force, 6)
    60.0
    """

    material: Material
    thickness: float
    shape: str = "flat"
    area: float | None = None
    radius: float | None = None
    second_radius: float | None = None
    length: float | None = None
    damping: float = 0.0
    rate: tuple[float, float, float] = (0.0, 0.0, 1.0)
    unloading: tuple[float, float] = (1.0, 1.0)
    bottom: tuple[float, float] = (0.8, 1e7)
    half_width: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        values: dict[str, object] = {"material": material(self.material)}
        values["thickness"] = positive("covering.thickness", self.thickness)
        needed = _NEEDED[word("covering.shape", self.shape, SHAPES)]
        for name in ("area", "radius", "second_radius", "length", "half_width"):
            given = getattr(self, name)
            if given is not None:
                values[name] = positive(f"covering.{name}", given)
            elif name in needed:
                raise InvalidParameterError(f"covering.{name}", f"be given for shape {self.shape!r}", None)
            if given is not None and name not in (*needed, "half_width", "second_radius"):
                raise InvalidParameterError(f"covering.{name}", f"be None for shape {self.shape!r}", given)
        if self.half_width is not None and self.shape == "flat":
            remedy = "a flat contact has its area whatever the compression: leave it out, or give a curved shape"
            raise InvalidParameterError("covering.half_width", "be None for shape 'flat'", self.half_width, remedy)
        if self.second_radius is not None and self.shape != "curved":
            raise InvalidParameterError("covering.second_radius", "be None unless curved", self.second_radius)
        values["damping"] = not_negative("covering.damping", self.damping)
        for name, count in (("rate", 3), ("unloading", 2), ("bottom", 2)):
            values[name] = _tuple(f"covering.{name}", getattr(self, name), count)
        for name, value in values.items():
            object.__setattr__(self, name, value)
        self.column(0.0)

    @classmethod
    def from_foam(cls, foam: Any, *, tested_area: float, area: float | None = None) -> Covering:
        """Return the flat covering of a foam that was identified from tests.

        E = K_c T/A of the test. Beyond the linear range, which is all that was tested, the covering counts as
        bottomed: allowed speeds stay within it.

        Parameters
        ----------
        foam : impact.Foam
            Stiffness, damping, thickness and linear range, for example of `impact.identify_foam` by
            ``fit.foam(moving_mass)``.
        tested_area : float
            Area of the specimen or indenter in m^2.
        area : float or None
            Area of the contact in m^2, that of the test when ``None``; stiffness and damping are in proportion.

        Returns
        -------
        Covering
            Linear and flat, with the damper of the foam.

        Raises
        ------
        InvalidParameterError
            If a number is out of its range.

        Examples
        --------
        >>> from hrsafety import contact, impact
        >>> pad = contact.Covering.from_foam(impact.FOAM_1, tested_area=5e-3)
        >>> round(pad.column(0.001).force, 6)
        24.3
        """
        missing = [name for name in ("stiffness", "damping", "thickness", "linear_range") if not hasattr(foam, name)]
        if missing:
            rule = f"be a foam with {', '.join(missing)}"
            raise InvalidParameterError("foam", rule, foam, "a fit gives one by .foam(moving_mass)")
        tested = positive("tested_area", tested_area)
        touched = tested if area is None else positive("area", area)
        return cls(
            material=Linear(modulus=foam.stiffness * foam.thickness / tested),
            thickness=foam.thickness,
            area=touched,
            damping=foam.damping * touched / tested,
            bottom=(min(foam.linear_range / foam.thickness, _DEEPEST), 1e7),
        )

    def column(self, compression: float) -> CompressedCovering:
        """Return force, stored work, pressure and widths at a compression.

        Parameters
        ----------
        compression : float
            d in m, below where the law ends.

        Returns
        -------
        CompressedCovering
            At rest: without rate, damper and unloading.

        Raises
        ------
        InvalidParameterError
            If the compression is negative or beyond the law.
        """
        from_row = {**self.numbers(), "stiffness": math.nan}
        row = [from_row.get(name, math.nan) for name in _hrsafety.contact_names()]
        depth = number("compression", compression)
        force, energy, pressure, widths = _hrsafety.contact_column(self.shared() | {"region": "rigid"}, row, depth)
        radii = [from_row["radius"], from_row["second_radius"]]
        flags = shape_flags(depth, radii=radii, thickness=self.thickness, half_width=self.half_width)
        pair = None if widths is None else (widths[0], widths[1])
        return CompressedCovering(force, energy, pressure, pair, tuple(name for name, flag in flags.items() if flag))

    def shared(self) -> dict[str, object]:
        """Return what is no number, as the core reads it."""
        law = self.material
        points = isinstance(law, StressTable)
        return {
            "law": law.law,
            "strain": list(law.strain) if points else [],  # type: ignore[union-attr, arg-type]  # arrays of a table
            "stress": list(law.stress) if points else [],  # type: ignore[union-attr, arg-type]  # arrays of a table
            "outline": "curved" if self.shape == "sphere" else self.shape,
            "tolerance": 1e-8,
        }

    def numbers(self) -> dict[str, float]:
        """Return the numbers of a row by name."""
        values = {"thickness": self.thickness, "damping": self.damping}
        for name in ("area", "radius", "second_radius", "length"):
            given = getattr(self, name)
            # Without a second radius the core takes the first one for both.
            values[name] = math.nan if given is None else given
        values |= dict(zip(("rate_base", "rate_slope", "rate_reference"), self.rate, strict=True))
        values |= dict(zip(("unloading_retained", "unloading_exponent"), self.unloading, strict=True))
        values |= dict(zip(("bottoming_strain", "backing_stiffness"), self.bottom, strict=True))
        return values | {f"material_{place}": value for place, value in enumerate(self.material.numbers)}


def shape_flags(depth: Any, *, radii: Sequence[Any], thickness: Any, half_width: float | None) -> dict[str, Any]:
    """Return where the columns under a curved contact do not describe it; every number may be an array."""
    if all(np.ndim(radius) == 0 and math.isnan(radius) for radius in radii):
        # Flat: nothing to compare.
        return {}
    with np.errstate(invalid="ignore"):
        least, largest = np.fmin(*radii), np.fmax(*radii)
        widest = math.inf if half_width is None else half_width
        return {
            "outside_paraboloid": np.asarray(depth) > 0.5 * least,
            "beyond_pad": np.sqrt(2.0 * largest * np.maximum(depth, 0.0)) > widest,
            "edge": least < _LEAST_RADIUS * np.asarray(thickness),
        }


def _tuple(name: str, given: object, count: int) -> Numbers:
    if not isinstance(given, (tuple, list)) or len(given) != count:
        raise InvalidParameterError(name, f"be {count} numbers", given)
    return tuple(number(f"{name}[{place}]", value) for place, value in enumerate(given))


@dataclass(frozen=True, kw_only=True, slots=True)
class Region:
    """A region of a body: a spring k x + k3 x^3, or k x^n.

    Parameters
    ----------
    k : float
        k in N/m, or N/m^n.
    k3 : float
        k3 in N/m^3.
    n : float or None
        Exponent of the power law.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Region(k=75e3)
    Region(k=75000.0, k3=0.0, n=None)
    """

    k: float
    k3: float = 0.0
    n: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, "k", positive("region.k", self.k))
        object.__setattr__(self, "k3", not_negative("region.k3", self.k3))
        if self.n is not None:
            object.__setattr__(self, "n", positive("region.n", self.n))
            if self.k3 != 0.0:
                raise InvalidParameterError("region.k3", "be 0 where n is given", self.k3)

    @property
    def kind(self) -> str:
        """The word of the core."""
        return "spring" if self.n is None else "power"

    def numbers(self) -> dict[str, float]:
        """Return the numbers of a row by name."""
        exponent = math.nan if self.n is None else self.n
        return {"stiffness": self.k, "region_cubic": self.k3, "region_exponent": exponent}


def covering_of(given: Covering | Mapping[str, object] | None) -> Covering | None:
    """Return the covering that is described, ``None`` if bare."""
    if given is None or isinstance(given, Covering):
        return given
    return Covering(**_known("covering", given, [each.name for each in fields(Covering)], ("material", "thickness")))  # type: ignore[arg-type]  # the class checks its numbers


def region_of(given: Region | Mapping[str, object] | float | None) -> Region | None:
    """Return the region that is described, ``None`` if rigid; a number is a spring constant."""
    if given is None or isinstance(given, Region):
        return given
    if isinstance(given, Mapping):
        return Region(**_known("region", given, ["k", "k3", "n"], ("k",))) if given else None  # type: ignore[arg-type]  # likewise
    return Region(k=number("region", given))


def _known(name: str, given: object, names: list[str], needed: tuple[str, ...]) -> dict[str, object]:
    if not isinstance(given, Mapping):
        raise InvalidParameterError(name, f"be a {name} or a mapping", given)
    for key in given:
        if key not in names:
            raise InvalidParameterError(name, f"have no keys but {', '.join(names)}", key, meant(key, names))
    missing = [key for key in needed if key not in given]
    if missing:
        raise InvalidParameterError(f"{name}.{missing[0]}", "be given", None)
    return dict(given)
