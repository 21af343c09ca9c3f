"""Friction of joints and gear motors in the field's own parameters: Coulomb, viscous and Stribeck.

law        torque against speed and temperature, with its derivatives
dwell_law  the same as the fit of dwells takes it
least      where the law gives the least torque
fitted     the law that describes the dwells, with its parameters
words      what these say
result     both together: `FrictionCurve`
fit        which law describes the dwells: `fit_friction`
"""
