"""The review page: one HTML file that says all of a plan in words, and shows it in 3D where there is JavaScript."""
