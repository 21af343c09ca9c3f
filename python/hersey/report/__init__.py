"""Pages: each one self-contained HTML file.

=============  ========================================
page           document and charts of a log in the page
life_page      those of a life test
life_decision  its first screen: who needs attention, and what to do
glossary       terms in plain words, for `hersey explain`, docs and tooltips
static         HTML, CSS and scripts
=============  ========================================
"""

from hersey.schema.callable_room import make_callable

make_callable(__name__, "hersey.report.page", "report")
