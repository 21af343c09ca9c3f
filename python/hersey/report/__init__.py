"""The page: one self-contained HTML file.

======  =====================================
page    document and charts put into the page
static  its HTML, CSS and script
======  =====================================
"""
