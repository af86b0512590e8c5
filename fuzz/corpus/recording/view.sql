DROP TABLE metric; CREATE VIEW metric AS SELECT id, 'a' AS name, time_s, time_s AS value FROM frame;
