"""What the document is made of: parts, and the schema of records.

=============  =====================================================================
part           `Part`, a frozen piece of the document that refuses what it does not know
record         `Record`, a data class that describes itself, and the part that holds it
callable_room  a package that can be called like the verb whose name it has
=============  =====================================================================
"""
