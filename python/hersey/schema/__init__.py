"""What the document is made of: parts, and the schema of records.

======  =====================================================================
part    `Part`, a frozen piece of the document that refuses what it does not know
record  the part that holds a record, from the fields of the record itself
======  =====================================================================
"""
