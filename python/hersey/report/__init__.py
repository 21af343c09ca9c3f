"""Pages: each one self-contained HTML file.

=========  ========================================
page       document and charts of a log in the page
life_page  those of a life test
static     HTML, CSS and scripts
=========  ========================================
"""
