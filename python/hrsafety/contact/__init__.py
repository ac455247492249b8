"""Contact with people within limits: coverings, collisions, allowed speeds, thicknesses, chances, bases, cells.

Every number here is a model: a measurement on the finished machine must confirm it.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.contact.annex import Annex as Annex, Assumption as Assumption, Hazard as Hazard, annex_of as annex_of
    from hrsafety.contact.base import DifferentialBase as DifferentialBase, HolonomicBase as HolonomicBase
    from hrsafety.contact.catalogs import CatalogMaterial as CatalogMaterial, load_materials as load_materials
    from hrsafety.contact.cell.cell import Cell as Cell, PlannedContact as PlannedContact
    from hrsafety.contact.cell.file import load_cell as load_cell
    from hrsafety.contact.cell.robot import ContactRobot as ContactRobot
    from hrsafety.contact.cell.study import ContactStudy as ContactStudy, study as study
    from hrsafety.contact.chance import Exceedance as Exceedance
    from hrsafety.contact.compression import load_compression_test as load_compression_test
    from hrsafety.contact.contact import Contact as Contact, Support as Support
    from hrsafety.contact.covering import (
        CompressedCovering as CompressedCovering,
        Covering as Covering,
        Region as Region,
    )
    from hrsafety.contact.drive import (
        Drive as Drive,
        drive_of as drive_of,
        push_limit_of_torques as push_limit_of_torques,
    )
    from hrsafety.contact.driven import (
        DrivenSpeed as DrivenSpeed,
        driven_loads as driven_loads,
        driven_speed as driven_speed,
        driven_speeds as driven_speeds,
    )
    from hrsafety.contact.driving import DrivenLoads as DrivenLoads
    from hrsafety.contact.least_thickness import LeastThickness as LeastThickness
    from hrsafety.contact.margins import (
        ContactMargins as ContactMargins,
        RegionSpeed as RegionSpeed,
        contact_margins as contact_margins,
        contact_speed_limit as contact_speed_limit,
    )
    from hrsafety.contact.materials import (
        Avalle as Avalle,
        GibsonAshby as GibsonAshby,
        Linear as Linear,
        Material as Material,
        Rusch as Rusch,
        StressTable as StressTable,
        material as material,
    )
    from hrsafety.contact.plan import MeasurementPlan as MeasurementPlan, PlannedMeasurement as PlannedMeasurement
    from hrsafety.contact.simulation import ContactBatch as ContactBatch, ContactImpact as ContactImpact
    from hrsafety.contact.speed import (
        AllowedSpeed as AllowedSpeed,
        AllowedSpeeds as AllowedSpeeds,
        free_from_fixed_force as free_from_fixed_force,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
