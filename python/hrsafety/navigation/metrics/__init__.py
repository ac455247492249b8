"""Scores and statistics of runs: social metrics, performance, shares and means with intervals, paired differences."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety._statistics import (
        Mean as Mean,
        Paired as Paired,
        Share as Share,
        compare_paired as compare_paired,
        mean_interval as mean_interval,
        wilson as wilson,
    )
    from hrsafety.navigation.bands import Band as Band
    from hrsafety.navigation.comparison import Comparison as Comparison, Standing as Standing, step_cost as step_cost
    from hrsafety.navigation.judging.assumptions import ShieldAssumption as ShieldAssumption
    from hrsafety.navigation.judging.judgement import Judgement as Judgement, Moment as Moment, judge as judge
    from hrsafety.navigation.judging.permit import Passing as Passing, PermitRules as PermitRules
    from hrsafety.navigation.judging.touches import Touch as Touch
    from hrsafety.navigation.judging.unjudged import NotJudged as NotJudged
    from hrsafety.navigation.metrics.declared import (
        METRICS as METRICS,
        Metric as Metric,
        WORLD_METRICS as WORLD_METRICS,
    )
    from hrsafety.navigation.metrics.episode import Episode as Episode
    from hrsafety.navigation.metrics.scores import (
        EpisodeMetrics as EpisodeMetrics,
        MetricTable as MetricTable,
        WorldMetrics as WorldMetrics,
        evaluate as evaluate,
        evaluate_many as evaluate_many,
        evaluate_world as evaluate_world,
    )
    from hrsafety.navigation.performance import Performance as Performance
    from hrsafety.navigation.pursuits import Falsification as Falsification, Pursuit as Pursuit, falsify as falsify
    from hrsafety.navigation.safety_record import (
        SafetyDecision as SafetyDecision,
        SafetyRecord as SafetyRecord,
        record_safety as record_safety,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
