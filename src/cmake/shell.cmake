# The manual page and the completions, which the program tells of itself.
set(shell_folder ${PROJECT_BINARY_DIR}/shell)
file(MAKE_DIRECTORY ${shell_folder})
add_custom_command(TARGET arcslip_program POST_BUILD
  COMMAND arcslip_program help --man > ${shell_folder}/arcslip.1
  COMMAND arcslip_program help --completion bash > ${shell_folder}/arcslip
  COMMAND arcslip_program help --completion zsh > ${shell_folder}/_arcslip
  COMMAND gzip -9nf ${shell_folder}/arcslip.1
  VERBATIM)
install(FILES ${shell_folder}/arcslip.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${shell_folder}/arcslip DESTINATION share/bash-completion/completions)
install(FILES ${shell_folder}/_arcslip DESTINATION share/zsh/vendor-completions)
