"""Layouts of the exports of instruments, rebuilt with made-up numbers, and whether each is read right.

=========  ==================================================
truth      made-up measurements
sections   texts in sections
tables     one table in an unusual layout
workbooks  workbooks of Excel
cases      all of them
trying     what a command says, and what its advice leads to
=========  ==================================================
"""
