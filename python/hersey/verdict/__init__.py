"""What the exponents and the film say together.

=================  =======================================================================
regimes            the table: what each state of lubrication predicts
contact_regimes    the same for a contact that is known: its soft film over the dwells
explanations       everything that explains how torque varies with speed
regime             exponents against named regimes, and a verdict in words
friction           whether friction as of a joint describes the dwells
evidence           the film that a log measures
friction_verdict   what speed says about a friction force or coefficient
contact_verdict    what the measured exponents say of a contact
transition         where drag is least, by the contact and by a log
warnings           what must be known before a fit is trusted
held_values        channels that are clipped or stuck
checks             what in the numbers of a nip does not fit, the farthest off first
=================  =======================================================================
"""
