"""The room compares plans: pure functions from two plan files to what was lost and won between them; it judges nothing."""
