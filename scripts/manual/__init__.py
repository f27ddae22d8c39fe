"""The site of the documents: the documents of the checkout, and a reference that is generated from the code."""
