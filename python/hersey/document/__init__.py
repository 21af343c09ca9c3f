"""The analysis document: the contract between the package and the page.

=============  ================================================
parts          one part per result, versioned and validated
assembly       from a log to the document
decision       what to do: the first screen
display_units  one unit per quantity
film_part      the film of the nip
carried_part   what film, contact and rest of the drive take
thinning       fewer samples to show, the extremes among them
saved_fit      a fit read back from its JSON
consistency    whether the numbers of a saved fit agree with each other
=============  ================================================
"""
