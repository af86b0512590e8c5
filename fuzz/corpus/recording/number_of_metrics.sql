UPDATE meta SET value = 'many' WHERE key = 'num_metrics';
