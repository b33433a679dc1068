"""Questions about questions: which answers hold at the extremes."""

from obbcli.study.battery import stability
from obbcli.study.rows import Row, Stability

__all__ = ["Row", "Stability", "stability"]
