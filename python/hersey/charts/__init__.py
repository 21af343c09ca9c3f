"""One chart per result.

=============  ====================================================
style          sizes, colours, the smallest pieces
labels         where texts stand, so that none covers another
runtime        the Vega runtime, inlined in every page
render         from a chart to the content of a file
analysis       the charts of the analysis document
film           the regime chart and the Stribeck curve
inspection     the channels of a log
cycles         trace, cycles and fitted motion
operating_map  the operating map
plan           a drive profile and the motion
=============  ====================================================
"""

#: Kinds of file of a figure, and of a picture that may also be a page: it has tooltips and needs no network.
FIGURES = (".png", ".svg", ".pdf")
PICTURES = (".html", *FIGURES)
