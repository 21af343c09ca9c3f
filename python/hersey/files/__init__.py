"""Files as a command is given them, and as it leaves them.

==========  =================================================================
patterns    the files that names and patterns stand for
endings     what a file probably is, by the ending of its name
reading     a file that may change while it is read
text        opening a text file, and values of it in messages
headings    the first line of a small table: names with units
tables      tables as files, of which a spreadsheet runs no text
toml        a TOML file into tables: what each value is, and what is believed
toml_lines  which line of a TOML file holds a key, and what a wrong one should be
writing     writing whole or not at all
shipped     the examples that a wheel carries, copied into a new folder
==========  =================================================================
"""
