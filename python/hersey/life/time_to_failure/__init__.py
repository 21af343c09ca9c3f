"""What ends each specimen, and when: every indicator against its limit.

==============  ================================================================
way             `Mode`: the growth of an indicator and the ages at its limit
joined          draws of several failure modes side by side
first           `SpecimenEnd`: which way comes first, and when
attention       which specimens need attention, and when to look at the others
questions       what is to be decided: an age, a share, a cost
next_run        what to measure next, and how far it would help to decide
failing_before  what fails before an age: of new specimens, of those followed
deciding_run    what would decide a question about new specimens
decided         the share and the age of replacement, and what would decide them
ageing          whether anything ages, and before which age none can fail
unsure          what is not known of the ends, and what depends on priors
estimate        `time_to_failure`: the first end of each specimen, and of the population
==============  ================================================================
"""
