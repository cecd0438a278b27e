"""The pages of both methods, and the document that holds them."""
