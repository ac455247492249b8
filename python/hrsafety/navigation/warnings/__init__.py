"""What is to be said beside a result: of runs, scenarios and shields."""
