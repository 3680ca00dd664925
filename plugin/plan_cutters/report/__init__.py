"""One result, many writers: each format is a module with one function, and the output folder knows them all."""
