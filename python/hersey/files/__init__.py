"""Files as a command is given them, and as it leaves them.

===========  ==============================
text         opening a text file
toml         opening a TOML file
toml_values  its values: strings with units
writing      writing whole or not at all
===========  ==============================
"""
