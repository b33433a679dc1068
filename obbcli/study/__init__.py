"""Questions about questions: what speed costs in accuracy, which answers hold at the extremes."""
