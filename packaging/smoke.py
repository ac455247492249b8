"""Smoke test of an installed wheel: run where only hrsafety and numpy are installed."""

from __future__ import annotations

import importlib.metadata
import time
from pathlib import Path

import numpy as np

begin = time.process_time()
from hrsafety import contact, impact, scenarios, standards  # noqa: E402  # the import is timed
from hrsafety import navigation as nav  # noqa: E402  # the import is timed

imported = time.process_time() - begin

run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
assert run.outcome == "arrived", run.outcome
table = nav.simulate_many(scenarios.configuration("c2"), [nav.VirtualForceField(), nav.Khatib()])
assert len(table) == 2, len(table)
hit = impact.metrics(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.0)
assert np.isfinite(hit.peak_contact_force), hit
assert standards.limits("iso_ts_15066_2016") is not None
assert contact.__doc__

places = [Path(str(each.locate())) for each in importlib.metadata.files("hrsafety") or []]
size = sum(place.stat().st_size for place in places if place.exists())
version = importlib.metadata.version("hrsafety")
print(f"hrsafety {version}: import {imported * 1e3:.0f} ms on top of numpy, {size / 1e6:.1f} MB installed")
