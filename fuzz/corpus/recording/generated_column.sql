DROP TABLE frame; CREATE TABLE frame (id INTEGER PRIMARY KEY, time_s REAL, chunk INTEGER AS (length(hex(zeroblob(1000000)))));
