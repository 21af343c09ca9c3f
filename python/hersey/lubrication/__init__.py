"""The film between belt and roll, as theory has it.

================  =================================================================
lubricant         viscosity against temperature, pressure and shear rate
paper             Eqs. 5-10 of the paper
contact           the nip: moduli, width, pressure
film_result       the film at operating points: numbers, table, words
film              film thickness and drag by every law, and which holds
film_temperature  of a film that heat flows through and shear warms
asperities        the faces that slide: summits, boundary friction
checked_range     where the law of a mixed contact was checked
mixed             film and asperities share the load: torque, share, transition
mixed_drag        the drag of such a contact, for the motion of the belt
reynolds          the line contact solved numerically
================  =================================================================
"""
