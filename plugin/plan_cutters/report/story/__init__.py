"""Put a plan into words once: the terminal, the review page and pictures lay them out. May use: the document and domain."""
