"""Life tests of a generator that shares no law with hersey, and what hersey says of them.

The generator is written from physics alone and imports nothing of hersey; only ``product``, ``slips`` and
``suspects`` ask hersey, the first two through its public names.

==========  ============================================================================
films       film over flooded film against the layer of oil: tanh, and a Reynolds table
drive       the machine of a campaign: oil, nip, asperities, its torque, its machine file
states      what ages: viscosity, layer, roughness, friction, debris, width of the nip
mechanisms  ten ways to age, each for many specimens at many ages
modes       the failure modes of the machine file, and the age at which each happens
campaign    one campaign by its seed: machine, specimens, ages, limits, truth
tables      its tables of dwells with noise, its machine file and its truth as files
slips       campaigns with one mistake each, and whether it is named
suspects    the same mistakes by the diagnostics alone, without files
product     hersey asked for the ages, as a row of a .jsonl
score       the counts
page        the counts against the targets, as a page
==========  ============================================================================
"""
