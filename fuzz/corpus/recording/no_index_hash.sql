DELETE FROM meta WHERE key = 'index_hash';
