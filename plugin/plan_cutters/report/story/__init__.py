"""What is told of a plan, once: the terminal, the review page and pictures lay it out. May use: the document and domain."""
