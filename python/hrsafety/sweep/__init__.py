"""Sweeps of any size: designs over named axes, studies of impacts and runs, results with units.

A design says which rows, a study what is computed for each. `run` does it in chunks that are
written as they finish, here, in any ``concurrent.futures`` executor or on a Dask cluster; the
same call resumes after a stop. Sampled designs need SciPy, data frames Polars, N-dimensional
tables xarray (extra ``sweep``), clusters dask.distributed (extra ``distributed``).
"""

from hrsafety._calls import suggest
from hrsafety.sweep.axes import Axis, Column
from hrsafety.sweep.designs import Design, Grid
from hrsafety.sweep.estimates import SweepEstimate, estimate
from hrsafety.sweep.function_study import FunctionStudy
from hrsafety.sweep.impact_study import ImpactStudy
from hrsafety.sweep.navigation_study import NavigationStudy
from hrsafety.sweep.result import SweepResult, open
from hrsafety.sweep.running import SweepInterrupted, SweepWarning, run
from hrsafety.sweep.sampled_designs import LatinHypercube, Saltelli, Sobol
from hrsafety.sweep.shares import SweepShares
from hrsafety.sweep.sobol_indices import SobolIndices, sobol_indices
from hrsafety.sweep.search_problem import Generation, SearchProblem
from hrsafety.sweep.storage import SweepError
from hrsafety.sweep.studies import Cases, Study

__all__ = [
    "Axis",
    "Cases",
    "Column",
    "Design",
    "FunctionStudy",
    "Generation",
    "Grid",
    "ImpactStudy",
    "LatinHypercube",
    "NavigationStudy",
    "Saltelli",
    "SearchProblem",
    "Sobol",
    "SobolIndices",
    "Study",
    "SweepError",
    "SweepEstimate",
    "SweepInterrupted",
    "SweepResult",
    "SweepShares",
    "SweepWarning",
    "estimate",
    "open",
    "run",
    "sobol_indices",
]

suggest(__all__, globals())
