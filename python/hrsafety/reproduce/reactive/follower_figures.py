"""Pictures of the follower: single layouts, laws, rates."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hrsafety import plotting, reactive
from hrsafety.pages import Picture
from hrsafety.reactive.follower.layouts import Kind
from hrsafety.reproduce.data import caption
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.reactive.follower_study import KINDS, LAWS, SETTINGS, FollowerStudy
from hrsafety.reproduce.reactive.follower_tables import SECOND

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["make"]

PUBLISHED = {"static": "13", "one_dynamic": "15", "two_dynamic": "16"}


def make(study: FollowerStudy) -> list[Picture]:
    """Draw every picture."""
    return [picture(name, caption, figure) for name, caption, figure in _drawings(study)]


def _drawings(study: FollowerStudy) -> Iterator[tuple[str, str, Figure]]:
    yield (
        "follower_forces",
        caption("follower_forces"),
        plotting.reactive.impedance_forces(
            {
                "conventional (19-a)": reactive.VirtualImpedance(form="conventional"),
                "active (20)": reactive.VirtualImpedance(),
                "(20) without its limit": reactive.VirtualImpedance(clamp=False),
                "(19-b) as printed": reactive.VirtualImpedance(form="twice_scaled"),
            }
        ),
    )
    for kind in KINDS:
        seed = _telling(study, kind)
        scene = reactive.FollowerLayouts(kind=kind).scene(seed)
        laws = {law: study.base[kind, law].law for law in LAWS}
        layouts = len(study.base[kind, "active"])
        runs = {f"{law} law": reactive.follow(scene, law=laws[law], seed=seed) for law in LAWS}
        yield (
            f"follower_{kind}",
            caption(
                "follower_layout",
                setting=SETTINGS[kind].capitalize(),
                figure=PUBLISHED[kind],
                seed=seed,
                layouts=layouts,
            ),
            plotting.reactive.follower_runs(runs),
        )
    yield (
        "follower_rates",
        caption("follower_rates", layouts=len(study.base["static", "active"])),
        plotting.reactive.follower_rates(
            {SETTINGS[kind]: {law: study.base[kind, law].collision_rate for law in LAWS} for kind in KINDS},
            marks={SETTINGS[kind]: {law: SECOND[f"{kind}_{law}"][0] for law in LAWS} for kind in KINDS},
            marks_label="second implementation",
        ),
    )
    names = {"as specified": "front", "mirrored rear sensors": "front and rear"}
    yield (
        "follower_rear",
        caption("follower_rear"),
        plotting.reactive.follower_rates(
            {
                SETTINGS[kind]: {
                    label: study.found[variant][kind, "active"].collision_rate for variant, label in names.items()
                }
                for kind in KINDS
            }
        ),
    )


def _telling(study: FollowerStudy, kind: Kind) -> int:
    """Return the first layout in which the conventional law touches and the active law follows."""
    telling = study.base[kind, "conventional"].collided & study.base[kind, "active"].follows
    return int(study.base[kind, "active"].seed[int(telling.argmax())])
