"""What a person or a program reads: one record a question, shown as JSON or as tables.

Last room of the flow: mesh -> tree -> query -> report. Answers come in, text goes out.
"""
