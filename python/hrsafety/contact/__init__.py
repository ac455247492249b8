"""Contact with people within limits: coverings, collisions, allowed speeds, thicknesses, chances, mobile bases.

Every number here is a model: a measurement on the finished machine must confirm it.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.contact.base import DifferentialBase, HolonomicBase
    from hrsafety.contact.catalogs import CatalogMaterial, load_materials
    from hrsafety.contact.chance import Exceedance, probability
    from hrsafety.contact.covering import Column, Covering, Region
    from hrsafety.contact.least_thickness import LeastThickness, thickness
    from hrsafety.contact.margins import ContactMargins, RegionSpeed, contact_margins, contact_speed_limit
    from hrsafety.contact.materials import Avalle, GibsonAshby, Linear, Material, Rusch, StressTable, material
    from hrsafety.contact.sensitivities import sensitivity
    from hrsafety.contact.simulation import ContactBatch, ContactImpact, batch, simulate
    from hrsafety.contact.speed import (
        AllowedSpeed,
        AllowedSpeeds,
        allowed_speed,
        allowed_speeds,
        free_from_fixed_force,
    )

__all__ = [
    "AllowedSpeed",
    "AllowedSpeeds",
    "Avalle",
    "CatalogMaterial",
    "Column",
    "ContactBatch",
    "ContactImpact",
    "ContactMargins",
    "Covering",
    "DifferentialBase",
    "Exceedance",
    "GibsonAshby",
    "HolonomicBase",
    "LeastThickness",
    "Linear",
    "Material",
    "Region",
    "RegionSpeed",
    "Rusch",
    "StressTable",
    "allowed_speed",
    "allowed_speeds",
    "batch",
    "contact_margins",
    "contact_speed_limit",
    "free_from_fixed_force",
    "load_materials",
    "material",
    "probability",
    "sensitivity",
    "simulate",
    "thickness",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.contact.base": "DifferentialBase HolonomicBase",
            "hrsafety.contact.catalogs": "CatalogMaterial load_materials",
            "hrsafety.contact.chance": "Exceedance probability",
            "hrsafety.contact.covering": "Column Covering Region",
            "hrsafety.contact.least_thickness": "LeastThickness thickness",
            "hrsafety.contact.margins": "ContactMargins RegionSpeed contact_margins contact_speed_limit",
            "hrsafety.contact.materials": "Avalle GibsonAshby Linear Material Rusch StressTable material",
            "hrsafety.contact.sensitivities": "sensitivity",
            "hrsafety.contact.simulation": "ContactBatch ContactImpact batch simulate",
            "hrsafety.contact.speed": "AllowedSpeed AllowedSpeeds allowed_speed allowed_speeds free_from_fixed_force",
        },
    )
