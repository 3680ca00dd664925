"""Parts that bounds are asked about in every run, one of most families; the others take minutes."""

DAILY = {"body_in_body", "plate_limit", "three_sides", "opposed_slots", "sphere_pocket", "lens", "tube", "cone_boss"}
