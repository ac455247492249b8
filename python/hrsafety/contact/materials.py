"""Laws of compressive stress over strain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, finite, vector
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = ["Avalle", "GibsonAshby", "Linear", "Material", "Rusch", "StressTable", "material"]


class _Law:
    """Base of the material laws: a word, and their numbers in the order of the core."""

    __slots__ = ()
    law: ClassVar[str]
    keys: ClassVar[dict[str, str]]

    def __post_init__(self) -> None:
        """Take the numbers as finite floats; a covering checks their ranges."""
        for name in self.keys.values():
            object.__setattr__(self, name, finite(f"material.{name}", getattr(self, name)))

    @property
    def numbers(self) -> tuple[float, ...]:
        """The numbers of the law, in the order of its fields."""
        return tuple(getattr(self, name) for name in self.keys.values())


@dataclass(frozen=True, kw_only=True, slots=True)
class Linear(_Law):
    """Stress E e.

    Parameters
    ----------
    modulus : float
        E in Pa.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Linear(modulus=121_250.0)
    Linear(modulus=121250.0)
    """

    law: ClassVar[str] = "linear"
    keys: ClassVar[dict[str, str]] = {"E": "modulus"}
    modulus: float


@dataclass(frozen=True, kw_only=True, slots=True)
class GibsonAshby(_Law):
    """Elastic, then a plateau, then densification.

    E e up to e_y = s_p/E; s_p up to e_p = e_D (1 - D^(-1/m)); then s_p/D (e_D/(e_D - e))^m.

    Parameters
    ----------
    modulus, plateau : float
        E and s_p in Pa.
    lock : float
        Strain e_D that is never reached.
    ratio : float
        D.
    exponent : float
        m.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9).exponent
    1.0
    """

    law: ClassVar[str] = "gibson_ashby"
    keys: ClassVar[dict[str, str]] = {
        "E": "modulus",
        "plateau": "plateau",
        "e_D": "lock",
        "D": "ratio",
        "m": "exponent",
    }
    modulus: float
    plateau: float
    lock: float
    ratio: float = 2.3
    exponent: float = 1.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Rusch(_Law):
    """Stress a e^p + b e^q, 0 < p <= 1 < q.

    Parameters
    ----------
    a, p, b, q : float
        a and b in Pa; a = 0 is a pure power law.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Rusch(a=18e3, p=0.5, b=190e3, q=5.0).law
    'rusch'
    """

    law: ClassVar[str] = "rusch"
    keys: ClassVar[dict[str, str]] = {"a": "a", "p": "p", "b": "b", "q": "q"}
    a: float
    p: float
    b: float
    q: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Avalle(_Law):
    """Stress A (1 - exp(-(E/A) e (1-e)^m)) + B (e/(1-e))^n.

    Parameters
    ----------
    plateau, modulus : float
        A and E in Pa.
    falloff : float
        m.
    densification : float
        B in Pa.
    exponent : float
        n.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Avalle(plateau=22e3, modulus=3e5, falloff=0.0, densification=9e3, exponent=2.0).law
    'avalle'
    """

    law: ClassVar[str] = "avalle"
    keys: ClassVar[dict[str, str]] = {
        "A": "plateau",
        "E": "modulus",
        "m": "falloff",
        "B": "densification",
        "n": "exponent",
    }
    plateau: float
    modulus: float
    falloff: float
    densification: float
    exponent: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StressTable(_Law):
    """Measured stress over strain, linear between the points.

    Parameters
    ----------
    strain, stress : array_like
        Points from (0, 0) on, stress in Pa; the strain rises and the stress does not fall. Nothing is
        known beyond the last point.
    warnings : sequence of ResultWarning
        Doubts about the test that the points are of, which every result with this material has.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.StressTable(strain=[0.0, 0.1, 0.6], stress=[0.0, 8e3, 20e3]).stress.tolist()
    [0.0, 8000.0, 20000.0]
    """

    law: ClassVar[str] = "table"
    keys: ClassVar[dict[str, str]] = {}
    strain: npt.ArrayLike
    stress: npt.ArrayLike
    warnings: Sequence[ResultWarning] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        """Take the points as arrays that cannot change."""
        object.__setattr__(self, "warnings", checked_doubts("material.warnings", self.warnings))
        for name in ("strain", "stress"):
            points: Array = np.array(vector(f"material.{name}", getattr(self, name)))
            if not np.isfinite(points).all():
                raise InvalidParameterError(f"material.{name}", "be finite", float(points[~np.isfinite(points)][0]))
            points.flags.writeable = False
            object.__setattr__(self, name, points)

    def __eq__(self, other: object) -> bool:
        """Compare the points."""
        if not isinstance(other, StressTable):
            return NotImplemented
        return np.array_equal(self.strain, other.strain) and np.array_equal(self.stress, other.stress)

    def __hash__(self) -> int:
        """Hash the points."""
        return hash((np.asarray(self.strain).tobytes(), np.asarray(self.stress).tobytes()))


Material = Linear | GibsonAshby | Rusch | Avalle | StressTable
_LAWS: dict[str, type[Material]] = {each.law: each for each in (Linear, GibsonAshby, Rusch, Avalle, StressTable)}


def material(given: Material | Mapping[str, object]) -> Material:
    """Return a law from what describes it.

    Parameters
    ----------
    given : Material or mapping
        A law, or a mapping with ``"law"`` and its numbers, by the symbols of the equations or by the
        names of the class: ``{"law": "linear", "E": 1e5}``.

    Returns
    -------
    Material
        The law.

    Raises
    ------
    InvalidParameterError
        If the law or a key is not known, or a number is missing.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.material({"law": "linear", "E": 1e5})
    Linear(modulus=100000.0)
    """
    if isinstance(given, (Linear, GibsonAshby, Rusch, Avalle, StressTable)):
        return given
    if not isinstance(given, Mapping):
        raise InvalidParameterError("material", "be a material or a mapping", given)
    values = dict(given)
    word = values.pop("law", None)
    kind = _LAWS.get(word) if isinstance(word, str) else None
    if kind is None:
        shown = ", ".join(f'"{each}"' for each in _LAWS)
        raise InvalidParameterError("material.law", f"be one of {shown}", word, meant(word, _LAWS))
    own = kind.keys or {"strain": "strain", "stress": "stress"}
    names: dict[str, object] = {}
    for key, value in values.items():
        name = own.get(key, key)
        if name not in own.values():
            shown = ", ".join(own)
            raise InvalidParameterError("material", f"have no keys but law, {shown}", key, meant(key, own))
        names[name] = value
    optional = {"ratio", "exponent"} if kind is GibsonAshby else set()
    for key, name in own.items():
        if name not in names and name not in optional:
            raise InvalidParameterError(f"material.{key}", f"be given for {word}", None)
    return kind(**names)  # type: ignore[arg-type]  # the class checks its numbers
