"""Work that outgrows a machine, or one thread of it: cut into tasks, each done once, wherever.

==========  ==================================================================================
module      responsibility
==========  ==================================================================================
cluster     a cluster of Dask: on this machine or by its address
tasks       tasks done in threads or by the workers of a cluster: results as they end
==========  ==================================================================================
"""
