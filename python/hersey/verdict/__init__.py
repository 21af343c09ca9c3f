"""What the exponents and the film say together.

========  ==============================================================
regimes   the table: what each state of lubrication predicts
regime    exponents against named regimes, and a verdict in words
evidence  the film that a log measures, and what its exponents speak for
checks    what in the numbers of a nip cannot be
========  ==============================================================
"""
