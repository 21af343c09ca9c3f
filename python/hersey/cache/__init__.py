"""What a command read and fitted, kept on disk for the next one: it reads no log again and fits none twice.

=========  ===============================================================================
switch     whether results are kept, and where
kept       ``@kept``: a function whose results are kept; all of them carry it
entries    one file for each result: whole or ignored, bounded, the least recently used go
encoding   arguments and results as JSON and arrays, and back
origin     what all results depend on besides arguments: program, libraries, processor
=========  ===============================================================================

A result is found by the hash of the function, of all arguments to the last bit, and of the origin. So nothing
gets stale, and nothing has to be deleted: what changed has another hash. A log counts by the hash of its
bytes. Commands use the cache; in Python nothing does.
"""
