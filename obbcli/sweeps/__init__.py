"""Sweeps: one pair of bodies, many motions, all answered.

`sweep` takes and returns arrays. The command line streams rows of a file through `stream`, on this
machine's cores or on a Dask cluster, into a results file that can be resumed.
"""
