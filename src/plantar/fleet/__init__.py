"""Many logs of many robots: groups fitted on `dask.distributed`, kept as they are finished, and looked at together."""
