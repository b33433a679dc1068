"""Questions about questions: what speed costs in accuracy, which answers hold at the extremes."""

from obbcli.study.asked import tradeoff
from obbcli.study.battery import stability
from obbcli.study.rows import Row, Stability
from obbcli.study.trials import Tradeoff, Trial

__all__ = ["Row", "Stability", "Tradeoff", "Trial", "stability", "tradeoff"]
