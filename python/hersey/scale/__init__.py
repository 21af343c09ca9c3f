"""Work that outgrows a machine, or one thread of it: cut into tasks, each done once, wherever.

============  ==================================================================================
module        responsibility
============  ==================================================================================
local         worker processes on this machine
worker        what runs in one
cluster       a cluster of Dask, by its client or address
tasks         tasks done in threads, in processes or by the workers of a cluster: results as they end
cutting       a grid cut into chunks
store         what is kept of a grid that is worked out chunk by chunk
zarr_reading  a kept sweep, each chunk checked when it is read
kinds         the kinds of folder, by the end of the name
============  ==================================================================================

A `zarr_folder` holds arrays with one file per chunk of each, a `parquet_folder` one file per chunk.
"""
