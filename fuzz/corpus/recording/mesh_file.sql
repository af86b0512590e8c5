UPDATE scene SET text = replace(text, 'grid = {', 'mesh = { file = "/etc/hostname", ');
