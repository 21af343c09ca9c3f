"""The site of the docs: pages made from the code, the navigation, and the build.

==========  ==========================================================================
commands    the reference of the commands, from the application itself
document    the reference of the JSON document, from its schema
files       the reference of the files that hersey reads, from the tables that read them
names       the reference of the Python names, one page per room
notebooks   the notebooks of the tutorial, from the Python blocks of its pages
said        what the code says of a field: comments, docstrings
described   the same for mkdocstrings, when the site is built
text        Markdown: tables and sections
pages       the pages that are made: ``python -m website`` renews them
gallery     the pictures of the gallery: ``python -m website.gallery`` makes them anew
navigation  which page stands where
build       the site in ``build/site``: ``make docs``
==========  ==========================================================================
"""
