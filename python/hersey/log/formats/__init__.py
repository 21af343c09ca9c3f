"""Files of every format but text: one reader each.

===========  =================================================================
opening      which reader opens a file: told by its first bytes, or its suffix
lvm          LabVIEW measurement files
tdms         LabVIEW TDMS
mdf          ASAM MDF, through asammdf in a process of its own, `mdf_worker`
matlab       MATLAB files; their layout is walked first by `matlab_tags`
hdf5         HDF5, and MATLAB 7.3
matrices     numbers in rows and columns, as the two before hold them
parquet      Parquet
frame        polars and pandas frames in memory
===========  =================================================================
"""

from hersey.log.formats.opening import READERS, opened, opener

__all__ = ["READERS", "opened", "opener"]
