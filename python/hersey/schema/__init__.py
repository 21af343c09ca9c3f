"""What results and the document are made of: parts, records and their schema, and warnings.

=============  =====================================================================
part           `Part`, a frozen piece of the document that refuses what it does not know
domain         `Domain`, a quantity against a speed: the torque of a rotation, or friction against sliding
record         `Record`, a data class that describes itself, and the part that holds it
warning        `Warning`, what is to be known of a result: kind, numbers, where, how grave, words
noun           what slides, by one word
callable_room  a package that can be called like the verb whose name it has
=============  =====================================================================
"""
