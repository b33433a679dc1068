"""The version, said once and below everything."""

# A literal, because asking the installed metadata costs three times a bare interpreter's start.
__version__ = "0.6.0"
