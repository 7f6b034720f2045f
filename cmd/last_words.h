/* Ends a program that can wait for nothing any more. */
#ifndef KILN_CMD_LAST_WORDS_H
#define KILN_CMD_LAST_WORDS_H

/* Removes half-written files, says the line (its newline included, at most 4096 bytes) where
 * standard error takes it at once, and ends the program. A signal's handler may call it, and a
 * thread beside one that hangs. */
_Noreturn void end_with_words(const char *line, int code);

#endif
