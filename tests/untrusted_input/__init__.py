"""Untrusted files: what they may do, attacked with files made here from the formats' own pages.

==============  ===================================================================================
mdf_blocks      writes MF4 and MDF 3 block by block, with any conversion
other_blocks    writes TDMS, MATLAB v4 and v5, LVM and tables, each number and length as one likes
seeds           one sound file of every reader
fuzz_read       damages the seeds and reads them: `make fuzz-read`
watching        which processes, files and processor time a call has cost
==============  ===================================================================================
"""
