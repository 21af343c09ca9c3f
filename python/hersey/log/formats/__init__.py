"""Files of every format but text: one reader each.

============  =================================================================
recognition   which format a file has
opening       opening a file in a process of its own
answering     what that process does: a reader opens the file, numbers are sent
lvm           LabVIEW measurement files
tdms          LabVIEW TDMS
mdf           ASAM MDF, through asammdf
formula       formulas that an MDF file carries, by a grammar of our own
matlab        MATLAB files; their layout is walked first by `matlab_tags`
cells         tables and lists of channels in cell arrays of MATLAB
hdf5          HDF5, and MATLAB 7.3
matrices      numbers in rows and columns, as the two before hold them
excel         workbooks of Excel, through polars and calamine
sheets        all cells of a workbook, for a layout
numpy_arrays  what NumPy saved
parquet       Parquet
frame         polars and pandas frames in memory
============  =================================================================
"""

from hersey.log.formats.opening import memory_limit, opened
from hersey.log.formats.recognition import READERS, format_of

__all__ = ["READERS", "format_of", "memory_limit", "opened"]
