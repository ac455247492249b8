"""Contact: closed-form speeds, chances, maps and nonlinear collisions on one core, beside a plain SciPy solution.

Rates are of the processor time of one thread; the accuracy of the collisions stands beside their speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from hrsafety import contact

FOAM = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)
POWERS = contact.Rusch(a=15e3, p=0.5, b=2e5, q=5.0)
# Exponents that are no products and roots.
OTHER_POWERS = contact.Rusch(a=15e3, p=0.43, b=2e5, q=4.3)
LIMITS = {"force": 280.0, "pressure": 380e4}


def pad(material: contact.Material, rate: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> contact.Covering:
    return contact.Covering(material=material, thickness=0.02, area=4e-3, rate=rate)


def hand(covering: contact.Covering) -> contact.Contact:
    return contact.Contact(robot=8.0, body=0.6, region=75e3, covering=covering)


def rate(rows: int, work: Callable[[], object]) -> float:
    """Return rows per second of processor time, the best of three."""
    spent = []
    for _ in range(3):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return rows / min(spent)


def test_closed_form_speeds(benchmark: Any) -> None:
    masses = np.linspace(2.0, 30.0, 1_000_000)
    for name, material in (("gibson_ashby", FOAM), ("linear", contact.Linear(modulus=2e5)), ("rusch", POWERS)):

        def speeds(material: Any = material) -> object:
            covering = pad(material)
            return hand(covering).allowed_speeds(LIMITS, robot_mass=masses, threads=1)

        benchmark.extra_info[f"{name} per s"] = rate(len(masses), speeds)
    benchmark.pedantic(speeds, rounds=1)
    print({name: f"{value:.3g}" for name, value in benchmark.extra_info.items()})


def test_map(benchmark: Any) -> None:
    def speeds() -> object:
        thickness, plateau = np.linspace(0.005, 0.05, 1000)[:, None], np.linspace(5e3, 40e3, 1000)
        return hand(pad(FOAM)).allowed_speeds(LIMITS, thickness=thickness, plateau=plateau, threads=1)

    print("map 1000 x 1000:", 1e6 / rate(10**6, speeds), "s")
    benchmark.pedantic(speeds, rounds=1)


def test_clamped_speeds_with_a_drive(benchmark: Any) -> None:
    """Drives of any stiffness: bare regions in closed form, coverings by simulations, with and without a detection."""
    masses = np.geomspace(3.0, 80.0, 12)
    drive = contact.Drive(reaction_time=0.02, deceleration=20.0)
    noticing = contact.Drive(reaction_time=0.02, deceleration=20.0, detection_force=20.0)
    bare = contact.Contact(robot=8.0, region=75e3)
    padded = contact.Contact(robot=8.0, region=75e3, covering=pad(FOAM))
    many = np.geomspace(3.0, 80.0, 100_000)
    info = benchmark.extra_info
    info["bare per s"] = rate(len(many), lambda: contact.driven_speeds(bare, drive, many, LIMITS))
    info["covered per s"] = rate(len(masses), lambda: contact.driven_speeds(padded, drive, masses, LIMITS))
    benchmark.pedantic(lambda: contact.driven_speeds(padded, noticing, masses[:2], LIMITS), rounds=1)
    noticed = rate(2, lambda: contact.driven_speeds(padded, noticing, masses[:2], LIMITS))
    info["covered, with a detection force, per s"] = noticed
    print({name: f"{value:.3g}" for name, value in info.items()})


def test_chance(benchmark: Any) -> None:
    def chance() -> object:
        return hand(pad(FOAM)).probability(
            0.5,
            robot_mass={"lognormal": [8.0, 0.2]},
            stiffness={"lognormal": [75e3, 0.2]},
            force_limit={"lognormal": [280.0, 0.2]},
            draws=10**6,
            threads=1,
        )

    print("10^6 draws:", 1e6 / rate(10**6, chance), "s")
    benchmark.pedantic(chance, rounds=1)


def plain(speed: float, covering: contact.Covering) -> float:
    """Return the peak force of a collision of 8 kg with 40 kg on a rigid region, by SciPy."""
    law = covering.material
    assert isinstance(law, contact.Rusch)
    base, slope, reference = covering.rate
    unit = covering.thickness * reference

    def force(total: float, closing: float) -> float:
        e = max(total, 0.0) / covering.thickness
        f = covering.area * (law.a * e**law.p + law.b * e**law.q)  # type: ignore[operator]  # numbers of the law
        return f * (1.0 + closing / unit) ** (base + slope * e) if closing > 0.0 else f

    def motion(_: float, y: Any) -> list[float]:
        return [y[1], -force(y[0], y[1]) * (1 / 8 + 1 / 40)]

    def parted(t: float, y: Any) -> float:
        return float(y[0]) if t > 1e-4 else 1.0

    parted.terminal = True  # type: ignore[attr-defined]  # as solve_ivp asks for
    found = solve_ivp(motion, (0.0, 0.2), [0.0, speed], rtol=1e-6, atol=1e-9, events=parted, dense_output=True)
    times = np.linspace(0.0, found.t[-1], 400)
    return max(force(*y) for y in found.sol(times).T)


def test_collisions(benchmark: Any) -> None:
    speeds = np.linspace(0.1, 0.6, 50_000)
    for name, material, rated in (
        ("gibson_ashby", FOAM, (0.0, 0.0, 1.0)),
        ("rusch", POWERS, (0.0, 0.0, 1.0)),
        ("gibson_ashby with rate", FOAM, (0.05, 0.02, 0.1)),
        ("rusch with rate", POWERS, (0.05, 0.02, 0.1)),
        ("rusch of other exponents", OTHER_POWERS, (0.0, 0.0, 1.0)),
        ("rusch of other exponents with rate", OTHER_POWERS, (0.05, 0.02, 0.1)),
    ):
        for region in (None, 25e3):

            def collide(material: Any = material, rated: Any = rated, k: float | None = region) -> Any:
                hit = contact.Contact(robot=8.0, body=40.0, region=k, covering=pad(material, rated))
                return hit.simulate_many(speeds, tolerance=1e-6, threads=1)

            hit = contact.Contact(robot=8.0, body=40.0, region=region, covering=pad(material, rated))
            exact = hit.simulate_many(speeds[::500], tolerance=1e-11)
            error = np.abs(collide().peak_force[::500] / exact.peak_force - 1.0).max()
            kind = f"{name}, {'rigid' if region is None else 'spring'}"
            print(f"{kind}: {rate(len(speeds), collide):.3g} per s, peak force within {error:.1e}")
    benchmark.pedantic(collide, rounds=1)
    covering = pad(POWERS, (0.05, 0.02, 0.1))
    some = speeds[::2500]
    start = time.process_time()
    peaks = [plain(speed, covering) for speed in some]
    spent = time.process_time() - start
    ours = contact.Contact(robot=8.0, body=40.0, covering=covering).simulate_many(some).peak_force
    print(f"SciPy: {len(some) / spent:.3g} per s, peak force within {np.abs(np.array(peaks) / ours - 1).max():.1e}")


def test_errors_of_random_collisions(benchmark: Any) -> None:
    """Errors of 2,000 random collisions with rate against a tolerance of 1e-12: three shapes, two laws, free bodies."""
    draw = np.random.default_rng(3)
    columns = ("peak_force", "peak_covering_compression", "release_time")
    shapes: list[dict[str, Any]] = [
        {"area": 4e-3},
        {"shape": "sphere", "radius": 0.08},
        {"shape": "cylinder", "radius": 0.05, "length": 0.1},
    ]
    errors: dict[float, list[list[float]]] = {1e-6: [], 1e-8: []}
    for index in range(2000):
        plateau, modulus = draw.uniform(8e3, 30e3), draw.uniform(1.5e5, 6e5)
        kinds: list[Any] = [
            contact.GibsonAshby(modulus=modulus, plateau=plateau, lock=draw.uniform(0.7, 0.95)),
            contact.Rusch(a=plateau, p=draw.uniform(0.3, 1.0), b=modulus, q=draw.uniform(3.0, 7.0)),
        ]
        rated = (draw.uniform(0.0, 0.1), draw.uniform(0.0, 0.04), 10.0 ** draw.uniform(-2.0, 0.0))
        thickness = draw.uniform(0.01, 0.04)
        covering = contact.Covering(material=kinds[index % 2], thickness=thickness, rate=rated, **shapes[index % 3])
        masses = {"robot": draw.uniform(2.0, 30.0), "body": draw.uniform(0.6, 60.0)}
        region = None if index % 4 < 2 else draw.uniform(1e4, 1e5)
        speed = draw.uniform(0.05, 0.8)

        def found(tolerance: float, own: Any = (masses, speed, region, covering)) -> list[float]:
            bodies, closing, stiffness, pad = own
            hit = contact.Contact(**bodies, region=stiffness, covering=pad)
            collided = hit.simulate_many([closing], tolerance=tolerance, threads=1)
            return [float(getattr(collided, name)[0]) for name in columns]

        exact = np.array(found(1e-12))
        for tolerance, each in errors.items():
            each.append(list(np.abs(np.array(found(tolerance)) / exact - 1.0)))
    benchmark.pedantic(lambda: None, rounds=1)
    for tolerance, rows in errors.items():
        for name, values in zip(columns, np.array(rows).T, strict=True):
            middle, most = float(np.nanmedian(values)), float(np.nanmax(values))
            benchmark.extra_info[f"{name}, {tolerance:g}"] = (middle, most)
            print(f"{name} at a tolerance of {tolerance:g}: median {middle:.1e}, largest {most:.1e}")
