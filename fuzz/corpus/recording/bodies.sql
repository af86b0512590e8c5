UPDATE body SET nodes = 4 WHERE id = 0; UPDATE chunk SET raw_bytes = 2 * (4 * 6 + 13) * 4;
