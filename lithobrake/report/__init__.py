"""The report of a study: reads the files of its folder, draws the figures, writes one page. Computes nothing new."""
