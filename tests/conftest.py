"""Every run tries the same examples, however slow the machine."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "repeatable",
    deadline=None,
    derandomize=True,
    database=None,
    # It is a clock too: on a busy machine any example takes long to make.
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")
