"""YAML files that robots are configured with: a reader without a library that keeps everything else."""
