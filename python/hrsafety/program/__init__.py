"""Robot programs: how fast a robot may move along its path beside people, and what that costs in cycle time.

Every number here is a model: a measurement on the finished machine must confirm it.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.program.drawn import DrawnProgram as DrawnProgram, DrawnStudy as DrawnStudy
    from hrsafety.program.draws import DrawnMotions as DrawnMotions
    from hrsafety.program.exposures import ContactPoint as ContactPoint, Segment as Segment
    from hrsafety.program.file import load_program as load_program
    from hrsafety.program.motion import ArmMotion as ArmMotion, Retimed as Retimed
    from hrsafety.program.moves import Move as Move
    from hrsafety.program.program import Program as Program
    from hrsafety.program.study import ProgramStudy as ProgramStudy
    from hrsafety.program.task import ZoneRules as ZoneRules
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
