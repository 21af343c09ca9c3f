"""What a user passes to a function, checked before anything is computed.

=======  ==================================================================
door     names and types of the arguments of one function
frozen   fields of records, which cannot be set, and how to make another one
numbers  numbers of whatever type, and what a value is in words
=======  ==================================================================
"""
