"""The analysis document: the contract between the package and the page.

===============  ========================================================
analysis         the document as a whole
assembly         from a study to the document
parts            what is laid out otherwise than the results it tells of
printed          what each command prints with ``--json``
saved_fit        a fit read back from its JSON
consistency      whether the numbers of a saved fit agree with each other
===============  ========================================================
"""
