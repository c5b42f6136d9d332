"""Files that logs come in, each as a table of named columns or as a record.

forms             what kind of file a log is
text, parquet_log, workbook, matlab, matlab_columns, nmea     their readers
table             columns of a log; rows: those a map names; in_memory: of what is in memory
sides             cells that say themselves to which side
"""
