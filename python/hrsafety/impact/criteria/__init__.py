"""Criteria of an impact: head injury, moving averages, filters of measured signals."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.impact.criteria.filters import (
        CHANNEL_CLASSES as CHANNEL_CLASSES,
        channel_corner as channel_corner,
        channel_filter as channel_filter,
    )
    from hrsafety.impact.criteria.loads import (
        HeadInjury as HeadInjury,
        ImpactMetrics as ImpactMetrics,
        MovingLevel as MovingLevel,
        average_3ms as average_3ms,
        clip_3ms as clip_3ms,
        hic as hic,
        hic_of_pulse as hic_of_pulse,
        metrics as metrics,
    )
    from hrsafety.impact.criteria.recorded import recorded_metrics as recorded_metrics
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
