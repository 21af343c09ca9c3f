"""One chart per result.

=============  ====================================================
style          sizes, colours, the smallest pieces
render         from a chart to its files
analysis       the charts of the analysis document
film           the regime chart and the Stribeck curve
inspection     the channels of a log
cycles         trace, cycles and fitted motion
operating_map  the operating map
plan           a drive profile and the motion
=============  ====================================================
"""
