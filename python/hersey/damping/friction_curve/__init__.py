"""Friction of joints and gear motors in the field's own parameters: Coulomb, viscous and Stribeck.

law    torque against speed and temperature, with its derivatives
"""
