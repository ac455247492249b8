"""Pictures of arms."""

from hrsafety.plotting.arms.ellipses import mass_ellipse

__all__ = ["mass_ellipse"]
