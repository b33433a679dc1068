"""What a question answers: statuses, brackets, evidence, counters. Values that know no geometry."""
