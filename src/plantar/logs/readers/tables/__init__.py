"""Tables: text and Parquet, one row a sample."""
