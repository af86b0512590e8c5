UPDATE frame SET time_s = 0.1;
