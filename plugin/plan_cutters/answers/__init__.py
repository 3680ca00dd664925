"""Answer the planner's next questions: the least stick-out, the largest radius at each place, and the next steps."""
